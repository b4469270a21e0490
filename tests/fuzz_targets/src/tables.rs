//! Text of other programs: tables, printed topics, and logs of the CMU course.
//!
//! The first byte selects the form, and its head is put before the rest, because no fuzzer would find it.

use robot_io::log::LogOptions;
use robot_io::log_bytes::LogBytes;

use crate::logs;
use crate::sentences::assert_sentence;

/// First lines, or the start of the first line, of each form.
const HEADS: [&str; 12] = [
    "time,x,y,heading,angle_min,angle_increment,ranges0,ranges1,ranges2\n",
    "angle,distance,quality\n",
    "time_us;angle_deg;range_mm\n",
    "%time,field.header.stamp,field.header.frame_id,field.angle_min,field.angle_max,field.angle_increment,field.time_increment,field.scan_time,field.range_min,field.range_max,field.ranges0,field.ranges1\n",
    "1,0,laser,-1.0,1.0,1.0,0.0,0.1,0.1,30.0,",
    "S  theta: 0.50 Dist: 00234.00 Q: 47\n",
    "O 0 0 0 1\n",
    "time,angle_min,angle_increment,ranges,intensities\n",
    "NaN,-1.0,-0.5,0.0,0.5,1.0\n",
    "0.0,1500,47,0.0\n3.0,1507,47,0.0\n",
    "VERTEX2 0 0 0 0\nROBOTLASER1 0 -1.5 3.1 0.5 12 0.1 0 ",
    "ODOMETRY 0 1 1 0 0 ",
];
/// Integers of a row of BreezySLAM.
const OF_BREEZY: usize = 706;

/// Reads without mapping, which the target `logs` does.
pub fn fuzz(data: &[u8]) {
    let Some((&form, text)) = data.split_first() else {
        return;
    };
    let read = |head: &str, options: &LogOptions| {
        logs::read(&[head.as_bytes(), text].concat(), options);
    };
    match usize::from(form) % (HEADS.len() + 2) {
        form if form < HEADS.len() => read(HEADS[form], &LogOptions::default()),
        form if form == HEADS.len() => {
            read(&("7 ".repeat(OF_BREEZY) + "\n"), &LogOptions::default());
        }
        _ => with_columns(text),
    }
}

/// A scan table whose odometry is in another file.
const SCANS: &[u8] =
    b"time,angle_min,angle_increment,ranges\n0,-1,1,1,2,3\n1,-1,1,1,2,3\n2,-1,1,1,2,3\n";

/// The first line names the columns, as `--columns` does; after an `@`, those of odometry beside a table of scans.
fn with_columns(text: &[u8]) {
    let end = text.iter().position(|&byte| byte == b'\n');
    let (names, rows) = text.split_at(end.map_or(text.len(), |end| end + 1));
    let names = String::from_utf8_lossy(names);
    let names = names.trim_end();
    if let Some(columns) = names.strip_prefix('@') {
        let parts = || [SCANS, rows].map(LogBytes::from).to_vec();
        logs::read_parts(parts(), SCANS.len(), &LogOptions::default());
        let file = format!("odom.csv@{columns}");
        match LogOptions::read([("odometry", file.as_str())]) {
            Ok(options) => drop(logs::read_parts(parts(), SCANS.len(), &options)),
            Err(rejection) => assert_sentence(&rejection),
        }
        return;
    }
    match names.parse() {
        Ok(columns) => {
            let options = LogOptions {
                columns: Some(columns),
                ..LogOptions::default()
            };
            logs::read(rows, &options);
        }
        Err(rejection) => assert_sentence(&rejection),
    }
}
