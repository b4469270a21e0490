//! Files of `slam2d run -o DIR` for other tools and for viewing.
//!
//! | file | content |
//! |---|---|
//! | `session.slam2d` | the complete state: input of `--continue`, `slam2d localize` and `slam2d map` |
//! | `graph.g2o` | the pose graph |
//! | `keyframes.jsonl` | the keyframes' scans with their poses: input of `slam2d map` |
//! | `report.html` | keyframes, loops and doubts with pictures |
//! | `map.pgm`, `map.yaml` | the map for Nav2's map_server |
//! | `map.png` | the same map for viewing |

use std::io::{self, Write};
use std::path::Path;

use robot_io::graph_file::GraphFile;
use robot_io::map_image::{MapMode, build_map, map_with_free_space};
use robot_io::quality::Quality;
use robot_io::recorder::RunRecorder;
use robot_io::report::Report;
use robot_io::run::LogRun;
use robot_io::session::FILE_NAME;

use crate::log_file::FileError;
use crate::optimize::write_whole;

/// Name of the file of keyframes.
pub const KEYFRAMES: &str = "keyframes.jsonl";

/// Cell size of the map, m: Nav2's default.
const MAP_CELL_M: f64 = 0.05;
/// Cell size of the report, m: finer cells are not visible in its picture.
const REPORT_CELL_M: f64 = 0.1;

/// Writes all files to an existing folder.
///
/// # Errors
/// If the system cannot write a file; the error contains the name.
pub fn write_folder(
    folder: &Path,
    log: &str,
    run: &LogRun,
    quality: &Quality,
    recorder: &RunRecorder,
    remarks: &[String],
    has_free_space: bool,
) -> Result<(), FileError> {
    let save = |name: &str, write: &dyn Fn(&mut Vec<u8>) -> io::Result<()>| {
        let path = folder.join(name);
        let mut bytes = Vec::new();
        let written = write(&mut bytes).and_then(|()| write_whole(&path, &bytes));
        written.map_err(|source| FileError::Io { path, source })
    };
    if let Some(session) = run.session() {
        save(FILE_NAME, &|out| out.write_all(&session.to_bytes()))?;
    }
    if let Some(slam) = run.slam() {
        save("graph.g2o", &|out| {
            out.write_all(GraphFile::from_pose_graph(slam.graph()).to_g2o().as_bytes())
        })?;
    }
    let lines = recorder.map_lines(run);
    save(KEYFRAMES, &|out| {
        lines.iter().try_for_each(|line| line.write(&mut *out))
    })?;
    let draw = if has_free_space {
        map_with_free_space
    } else {
        build_map
    };
    // A map too large for this resolution is skipped; `slam2d map --resolution` writes a coarser one.
    if let Ok(map) = draw(&lines, MAP_CELL_M) {
        save("map.pgm", &|out| map.write_pgm(out))?;
        save("map.png", &|out| map.write_png(out, MapMode::Trinary))?;
        save("map.yaml", &|out| {
            out.write_all(map.yaml("map.pgm", MapMode::Trinary).as_bytes())
        })?;
    }
    // A map too large for this resolution leaves the report without walls.
    let map = draw(&lines, REPORT_CELL_M).ok();
    let report = Report {
        name: log,
        scans: run.scans(),
        quality,
        chi2_over_time: recorder.chi2_over_time(),
        map: map.as_ref(),
        remarks,
    };
    save("report.html", &|out| {
        out.write_all(report.html().as_bytes())
    })
}
