//! Tables that people have, a few rows of each.

use crate::log::{LogFrame, LogNotes, LogOptions};
use crate::log_format::LogFormat;

fn read_with(text: &str, options: &LogOptions) -> (Vec<LogFrame>, LogNotes) {
    let mut reader = LogFormat::open(text.as_bytes(), "x.csv", options).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = reader.next_frame().unwrap() {
        frames.push(frame);
    }
    (frames, reader.notes().clone())
}

fn read(text: &str) -> Vec<LogFrame> {
    read_with(text, &LogOptions::default()).0
}

fn listed(numbers: impl Iterator<Item = f64>, separator: &str) -> String {
    let words: Vec<String> = numbers.map(|number| number.to_string()).collect();
    words.join(separator)
}

#[test]
fn a_scan_that_ros_prints_is_that_scan() {
    // ros_comm, rostopic: CSV of the fields; nanoseconds.
    let names: Vec<String> = (0..5).map(|beam| format!("field.ranges{beam}")).collect();
    let header = "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angle_min,field.angle_max,field.angle_increment,field.time_increment,field.scan_time,field.range_min,field.range_max";
    let text = format!(
        "{header},{},field.intensities0\n9,0,1700000000500000000,laser,-1,1,0.5,0,0.1,0.1,12,2,3,nan,inf,4,47\n",
        names.join(",")
    );
    let of_ros1 = read(&text);
    let row = "1700000000,500000000,laser,-1.0,1.0,0.5,0.0,0.1,0.1,12.0";
    let ranges = "2.0,3.0,nan,inf,4.0";
    let of_ros2 = read(&format!("{row},{ranges},47,47,47,47,47\n"));
    for frames in [of_ros1, of_ros2] {
        let [frame] = &frames[..] else {
            panic!("{frames:?}")
        };
        assert_eq!(frame.stamp_s, 1_700_000_000.5);
        let scan = &frame.scan;
        assert_eq!((scan.first_angle_rad, scan.angle_step_rad), (-1.0, 0.5));
        assert_eq!((scan.range_min_m, scan.range_max_m), (0.1, 12.0));
        assert_eq!(scan.ranges_m.len(), 5);
        assert_eq!((scan.ranges_m[1], scan.ranges_m[4]), (3.0, 4.0));
        assert!(scan.ranges_m[2].is_nan());
    }
    let cut = format!("{row},{ranges},...\n");
    let mut reader = LogFormat::open(cut.as_bytes(), "x.csv", &LogOptions::default()).unwrap();
    let error = reader.next_frame().unwrap_err().to_string();
    assert!(
        error.ends_with("in ROS ros2 topic echo --csv --full-length"),
        "{error}"
    );
}

#[test]
fn beams_become_a_scan_where_their_bearing_goes_back() {
    // A third turn that is not whole.
    let rows = (0..900).map(|k| {
        format!(
            "{}.{:04},{},{},{}\n",
            1_700_000_000,
            k,
            k % 360,
            2000 + k % 360,
            u8::from(k != 5)
        )
    });
    let text = format!(
        "timestamp,angle_deg,distance_mm,quality\n{}",
        rows.collect::<String>()
    );
    let (frames, notes) = read_with(&text, &LogOptions::default());
    let beams: Vec<usize> = frames
        .iter()
        .map(|frame| frame.scan.ranges_m.len())
        .collect();
    assert_eq!(beams, [360, 360, 180]);
    let scan = &frames[0].scan;
    // RPLidar counts clockwise: beam 90 looks to the right.
    assert!((scan.bearing_rad(90) + 90_f64.to_radians()).abs() < 1e-9);
    assert!((scan.ranges_m[90] - 2.09).abs() < 1e-12 && scan.ranges_m[5] == 0.0);
    assert!(
        (scan.beam_interval_s - 1e-4).abs() < 1e-6,
        "{}",
        scan.beam_interval_s
    );
    assert!(notes.about[0].contains("clockwise, as RPLidar does"));
    let sdk: String = (0..800)
        .map(|k| {
            let sync = if k % 400 == 0 { "S " } else { "  " };
            format!(
                "{sync} theta: {:.2} Dist: {:08.2} Q: 47 \n",
                0.9 * f64::from(k % 400),
                1500.0
            )
        })
        .collect();
    let frames = read(&sdk);
    assert_eq!(frames.len(), 2);
    assert_eq!(frames[1].scan.ranges_m.len(), 400);
    assert!(
        frames[1]
            .scan
            .ranges_m
            .iter()
            .all(|range_m| (range_m - 1.5).abs() < 1e-12)
    );
}

#[test]
fn a_row_of_breezyslam_is_a_scan_of_the_urg() {
    let row = format!(
        "212387282 14710 29221 25178 {} {}\n",
        listed((0..20).map(|_| 0.0), " "),
        listed((0..682).map(|beam| f64::from(1000 + beam)), " ")
    );
    let frames = read(&row);
    let scan = &frames[0].scan;
    assert_eq!(frames[0].stamp_s, 212.387_282);
    assert!((scan.ranges_m[681] - 1.681).abs() < 1e-12);
    assert!((scan.bearing_rad(681) - 120_f64.to_radians()).abs() < 1e-9);
}

#[test]
fn columns_are_named_by_the_user_or_asked_for() {
    let text = "1.5;10;20;90;0.5;2000;2100;2200\n2.5;11;20;90;0.5;2000;2100;2200\n";
    let columns = "time,x_cm,y_cm,heading_deg,angle_increment,ranges_mm";
    let options = LogOptions {
        columns: Some(columns.parse().unwrap()),
        ..LogOptions::default()
    };
    let (frames, _) = read_with(text, &options);
    assert_eq!(frames.len(), 2);
    let [x, y, heading] = frames[1].odometry.unwrap().to_array();
    assert!((x - 0.11).abs() < 1e-12 && (y - 0.2).abs() < 1e-12);
    assert!((heading - 90_f64.to_radians()).abs() < 1e-12);
    assert_eq!(frames[0].scan.ranges_m, [2.0, 2.1, 2.2]);
    for (columns, expected) in [
        ("time,colour,ranges", "there is no column colour; use time"),
        ("time,x", "name either ranges, or angle and range"),
    ] {
        let error = columns.parse::<super::TableLayout>().unwrap_err();
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn spreadsheets_of_other_countries_quotes_and_lists_are_read() {
    let head = "time;angle_min;angle_increment;ranges0;ranges1;ranges2";
    let expected = |frames: &[LogFrame]| {
        assert_eq!(frames.len(), 1, "{frames:?}");
        assert_eq!(frames[0].stamp_s, 0.5);
        assert_eq!(frames[0].scan.angle_step_rad, 0.25);
        let ranges_m = &frames[0].scan.ranges_m;
        assert_eq!(ranges_m.len(), 3);
        assert_eq!((ranges_m[0], ranges_m[2]), (1.5, 2.5));
        assert!(ranges_m[1].is_nan(), "{ranges_m:?}");
    };
    for (separator, point) in [(";", ","), ("\t", ","), (";", "."), (",", ".")] {
        // No reading between two, and a separator at the end of the row.
        let row = "0.5;-1;0.25;1.5;;2.5;".replace('.', point);
        let text = format!("{head}\r\n{row}\r\n").replace(';', separator);
        expected(&read(&text));
    }
    expected(&read(
        "\"time\",\"angle_min\",\"angle_increment\",\"ranges\"\n0.5,-1,\"0.25\",\"[1.5, nan, 2.5]\"\n",
    ));
    // The last beams of a header are not cut off if they have no reading.
    let frames = read(&format!("{head}\n0;-1;1;2;;\n"));
    assert_eq!(frames[0].scan.ranges_m.len(), 3);
}

#[test]
fn the_longest_reading_that_comes_again_and_again_is_no_wall() {
    let head = "time,angle_min,angle_increment,ranges";
    let (frames, notes) = read_with(
        &format!("{head}\n0,-1,0.1,2,8,8,8,8,3,8\n1,-1,0.1,2,3,8,4,3,3,2\n"),
        &LogOptions::default(),
    );
    assert!(frames.iter().all(|frame| frame.scan.range_max_m == 8.0));
    let said = &notes.warnings[0].text;
    assert!(
        said.contains("8 m, comes 5 times") && notes.warnings.len() == 1,
        "{said}"
    );
    // A round hall, and a wall seen by few beams.
    for row in ["2,2,2,2,2,2,2", "2,8,8,8,3,3,3"] {
        let frames = read(&format!("{head}\n0,-1,0.1,{row}\n"));
        assert_eq!(frames[0].scan.range_max_m, f64::INFINITY);
    }
}

#[test]
fn a_sweep_with_one_time_may_pass_the_bearing_where_counting_begins() {
    let beams = |step: usize, first: usize, in_degrees: bool| {
        let rows = (0..2).flat_map(|sweep| {
            (0..36).map(move |beam| {
                let degrees = (step * (first + beam) * 10) % 360;
                let angle = degrees as f64;
                let angle = if in_degrees {
                    angle
                } else {
                    angle.to_radians()
                };
                format!("{sweep},{angle},{}\n", 1 + beam)
            })
        });
        read(&format!("time,angle,range\n{}", rows.collect::<String>()))
    };
    for in_degrees in [false, true] {
        // From behind, counter-clockwise and clockwise.
        for step in [1, 35] {
            let frames = beams(step, 18, in_degrees);
            assert_eq!(frames.len(), 2);
            for frame in &frames {
                let expected: Vec<f64> = (1..=36).map(f64::from).collect();
                assert_eq!(frame.scan.ranges_m, expected);
            }
        }
    }
    // Sweeps whose times have too few digits still end where the bearing goes back.
    let rows = (0..3 * 36).map(|beam| format!("7,{},2\n", beam % 36 * 10));
    assert_eq!(
        read(&format!("time,angle,range\n{}", rows.collect::<String>())).len(),
        3
    );
}

#[test]
fn rows_that_python_printed_as_tuples_are_read_and_proposed() {
    let rows = (0..80).map(|k| format!("(15, {:.3}, {}.0)\n", 9 * (k % 40), 2000 + k * k));
    let text: String = rows.collect();
    let mut reader = LogFormat::open(text.as_bytes(), "x.txt", &LogOptions::default()).unwrap();
    let error = reader.next_frame().unwrap_err().to_string();
    let columns = "quality,angle_deg,range_mm";
    assert!(
        error.contains(&format!(
            "if its 3 columns are what they seem to be, pass --columns {columns} "
        )),
        "{error}"
    );
    let options = LogOptions {
        columns: Some(columns.parse().unwrap()),
        ..LogOptions::default()
    };
    let (frames, _) = read_with(&text, &options);
    assert_eq!((frames.len(), frames[1].scan.ranges_m.len()), (2, 40));
}

#[test]
fn a_scan_in_one_cell_has_all_its_beams() {
    let header = "time,frame,angle_min,angle_increment,ranges,intensities";
    for list in [
        "\"[1.5, 2.0, None, 3.5]\"",
        "\"(1.5, 2.0, , 3.5)\"",
        "\"1.5 2.0 nan 3.5\"",
        "[1.5 2.0 nan 3.5]",
        "\"array('f', [1.5, 2.0, nan, 3.5])\"",
    ] {
        let row = |stamp: u32| format!("{stamp},laser,-1,0.5,{list},\"[47, 47, 47, 47]\"\n");
        let frames = read(&format!("{header}\n{}{}", row(1), row(2)));
        assert_eq!(frames.len(), 2, "{list}");
        let ranges = &frames[1].scan.ranges_m;
        assert_eq!(
            (ranges.len(), ranges[0], ranges[3]),
            (4, 1.5, 3.5),
            "{list}"
        );
        assert!(ranges[2].is_nan(), "{list}");
    }
}

#[test]
fn the_times_of_a_simulation_are_nanoseconds_as_all_that_rostopic_prints() {
    let row = |ns: u64| format!("{ns},{ns},-1,0.5,1,2,3,4,5\n");
    let names: Vec<String> = (0..5).map(|beam| format!("field.ranges{beam}")).collect();
    let header = "%time,field.header.stamp,field.angle_min,field.angle_increment";
    let rows: String = (0..4)
        .map(|k| row(124_600_000_000 + 200_000_000 * k))
        .collect();
    let frames = read(&format!("{header},{}\n{rows}", names.join(",")));
    let stamps: Vec<f64> = frames.iter().map(|frame| frame.stamp_s).collect();
    // 1e-9 s: a nanosecond.
    assert!(
        (stamps[0] - 124.6).abs() < 1e-9 && (stamps[3] - 125.2).abs() < 1e-9,
        "{stamps:?}"
    );
}

#[test]
fn angles_come_from_the_first_row_or_from_the_columns() {
    let rows = "1.0,1.5,2.0,-1,3.0,3.5\n1.2,1.5,2.0,-1,3.0,3.5\n";
    let by_row = read(&format!("NaN,-1.0,-0.5,0.0,0.5,1.0\n{rows}"));
    let view = 1.0_f64.to_degrees();
    let options = LogOptions {
        columns: Some(format!("time,ranges@-{view}:{view}").parse().unwrap()),
        ..LogOptions::default()
    };
    for frames in [by_row, read_with(rows, &options).0] {
        assert_eq!(frames.len(), 2);
        let scan = &frames[1].scan;
        assert_eq!(frames[1].stamp_s, 1.2);
        // 1e-12 rad: degrees and back.
        assert!((scan.bearing_rad(0) + 1.0).abs() < 1e-12);
        assert!((scan.bearing_rad(4) - 1.0).abs() < 1e-12);
        assert!(!scan.is_return(scan.ranges_m[2]) && scan.is_return(scan.ranges_m[3]));
    }
    for wrong in [
        "time,ranges@90",
        "time,ranges@0:0",
        "angle,range@-1:1",
        "time,ranges@a:b",
    ] {
        let parsed: Result<crate::table_layout::TableLayout, String> = wrong.parse();
        assert!(parsed.unwrap_err().contains("ranges@-90:90") || wrong.starts_with("angle"));
    }
}

#[test]
fn a_table_of_no_known_form_is_answered_with_its_columns() {
    let rows = (0..40).map(|k| format!("{:.2},{:05}.00,47,0.0\n", 3 * k, 1500 + k * k));
    let text: String = rows.collect();
    let mut reader = LogFormat::open(text.as_bytes(), "x.csv", &LogOptions::default()).unwrap();
    let error = reader.next_frame().unwrap_err().to_string();
    let columns = "angle_deg,range_mm,quality,time";
    assert!(error.contains("‘0,01500.00,47,0.0’"), "{error}");
    assert!(
        error.contains(&format!("pass --columns {columns} ")),
        "{error}"
    );
    let options = LogOptions {
        columns: Some(columns.parse().unwrap()),
        ..LogOptions::default()
    };
    assert_eq!(read_with(&text, &options).0[0].scan.ranges_m.len(), 40);
}

#[test]
fn a_table_is_read_with_the_names_and_lines_that_people_write() {
    let row = "0.5,1,2,0.25,-1,0.5,1.5,N/A,2.5\n";
    let expected = read(&format!(
        "time,x,y,heading,angle_min,angle_increment,ranges0,ranges1,ranges2\n{row}"
    ));
    for header in [
        "# drive of monday, robot 3\ntime,x,y,heading,angle_min,angle_increment,ranges0,ranges1,ranges2",
        "sep=,\ntime,x,y,theta,angle_min,angle_increment,ranges0,ranges1,ranges2",
        "// time, angle, range\nTimestamp [s],pose_x,pose_y,pose_theta,angleMin,angle_increment (rad),range 0 [m],range 1 [m],range 2 [m]",
        "Zeit,Position X,Position Y,Winkel,Startwinkel,Winkelschritt,Abstand0,Abstand1,Abstand2",
        "stamp,odom.x,odom.y,odom.yaw,scan.angle_min,scan.angle_increment,scan.ranges[0],scan.ranges[1],scan.ranges[2]",
    ] {
        let frames = read(&format!("{header}\n{row}"));
        assert_eq!(frames[0].odometry, expected[0].odometry, "{header}");
        assert_eq!(frames[0].stamp_s, 0.5, "{header}");
        let (scan, wanted) = (&frames[0].scan, &expected[0].scan);
        assert_eq!(scan.first_angle_rad, wanted.first_angle_rad, "{header}");
        assert!(
            scan.ranges_m[1].is_nan() && scan.ranges_m.len() == 3,
            "{header}"
        );
        assert_eq!(scan.ranges_m[2], 2.5, "{header}");
    }
    let quaternion = read(
        "t,pose.position.x,pose.position.y,pose.orientation.x,pose.orientation.y,pose.orientation.z,pose.orientation.w,angles,ranges\n2023-11-14T22:13:20.5Z,1,2,0,0,1,0,\"[-90, 0, 90]\",\"[1, #N/A, 3]\"\n",
    );
    let [x, y, heading] = quaternion[0].odometry.unwrap().to_array();
    assert_eq!((x, y, heading.abs()), (1.0, 2.0, core::f64::consts::PI));
    assert_eq!(quaternion[0].stamp_s, 1_700_000_000.5);
    assert_eq!(quaternion[0].scan.bearing_rad(1), 0.0);
}

#[test]
fn a_row_that_is_cut_is_no_scan() {
    let head = "time,angle_min,angle_increment,ranges0,ranges1,ranges2\n";
    let row = |time: u8| format!("{time},-1,1,1.5,2.5,3.5\n");
    let text = format!("{head}{}1,-1,1,1.5\n{}3,-1,1,1.5", row(0), row(2));
    let (frames, notes) = read_with(&text, &LogOptions::default());
    assert_eq!(frames.len(), 2);
    let said = notes.sentences("x").join(" ");
    assert!(said.contains("line 3: it has 4 of 6 columns"), "{said}");
    assert!(said.contains("the last line, 5, is incomplete"), "{said}");
}

#[test]
fn of_several_lasers_in_a_table_one_is_read_and_the_others_are_named() {
    let row = |time: u8, laser: &str| format!("{time},{laser},-1,1,1.5,2.5\n");
    let rows: String = (0..4)
        .map(|time| row(time, "front") + &row(time, "rear"))
        .collect();
    let text = format!("time,sensor,angle_min,angle_increment,ranges0,ranges1\n{rows}");
    let (frames, notes) = read_with(&text, &LogOptions::default());
    assert_eq!(frames.len(), 4);
    let said = &notes.warnings[0].text;
    assert!(said.contains("--scan-topic rear chooses"), "{said}");
    let rear = LogOptions {
        scan_topic: Some("rear".to_owned()),
        ..LogOptions::default()
    };
    let (frames, notes) = read_with(&text, &rear);
    assert_eq!(frames.len(), 4);
    assert!(notes.warnings[0].text.contains("those of rear are read"));
}

#[test]
fn units_that_nobody_states_are_named() {
    let rows = |heading: fn(u32) -> u32, range: u32| -> String {
        let row = |k| format!("{k},0,0,{},-1,1,{range},1199,{range}\n", heading(k));
        (0..40).map(row).collect()
    };
    let header = "time,x,y,heading,angle_min,angle_increment,ranges0,ranges1,ranges2\n";
    let said = |header: &str, rows: String| -> String {
        let (_, notes) = read_with(&format!("{header}{rows}"), &LogOptions::default());
        notes.sentences("x").join(" ")
    };
    // 10° from row to row, and a heading that only passes half a turn.
    let turning = |k: u32| 10 * k % 360;
    let unstated = said(header, rows(turning, 3));
    assert!(
        unstated.contains("name the column heading_deg"),
        "{unstated}"
    );
    let stated = header.replace("heading", "heading_deg");
    assert!(!said(&stated, rows(turning, 3)).contains("heading_deg"));
    assert!(!said(header, rows(|k| k / 2 % 6, 3)).contains("heading_deg"));
    let centimetres = said(header, rows(|_| 0, 250));
    assert!(
        centimetres.contains("look like centimetres"),
        "{centimetres}"
    );
    assert!(!said(header, rows(|_| 0, 3)).contains("centimetres"));
}
