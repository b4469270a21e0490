//! Consistent and inconsistent fields.

use super::*;

fn fields() -> ScanFields {
    ScanFields {
        angle_min: -PI,
        angle_max: PI - TAU / 360.0,
        angle_increment: TAU / 360.0,
        range_max: 12.0,
        ranges_m: vec![2.0; 360],
        ..ScanFields::default()
    }
}

#[track_caller]
fn assert_taken(fields: ScanFields, first: f64, step: f64, words: &str) {
    let (scan, remarks) = fields.checked(0.1).unwrap();
    // 1e-6: 32-bit floats.
    assert!(
        (scan.first_angle_rad - first).abs() < 1e-6,
        "{}",
        scan.first_angle_rad
    );
    assert!(
        (scan.angle_step_rad - step).abs() < 1e-6,
        "{}",
        scan.angle_step_rad
    );
    let remarks = remarks.join(" ");
    assert_eq!(remarks.is_empty(), words.is_empty(), "{remarks}");
    assert!(remarks.contains(words), "{remarks}");
}

#[test]
fn inconsistent_angles_are_corrected_by_two_that_agree() {
    let (first, step) = (-PI, TAU / 360.0);
    assert_taken(fields(), first, step, "");
    // Some drivers state the angle after the last beam.
    assert_taken(
        ScanFields {
            angle_max: PI,
            ..fields()
        },
        first,
        step,
        "",
    );
    for increment in [0.0, f64::NAN, -step, 0.5 * step, 2.0 * step] {
        let other = ScanFields {
            angle_increment: increment,
            ..fields()
        };
        assert_taken(other, first, step, "angle_increment");
    }
    let degrees = ScanFields {
        angle_min: -180.0,
        angle_max: 179.0,
        angle_increment: 1.0,
        ..fields()
    };
    assert_taken(degrees.clone(), first, step, "degrees");
    assert_taken(
        ScanFields {
            angle_increment: step,
            ..degrees
        },
        first,
        step,
        "degrees",
    );
    assert_taken(
        ScanFields {
            angle_increment: 1.0,
            ..fields()
        },
        first,
        step,
        "degrees",
    );
    assert_taken(
        ScanFields {
            angle_max: f64::NAN,
            ..fields()
        },
        first,
        step,
        "",
    );
    assert_taken(
        ScanFields {
            angle_max: 40.0,
            ..fields()
        },
        first,
        step,
        "angle_increment is used",
    );
}

#[test]
fn inconsistent_angles_are_rejected() {
    let bad = ScanFields {
        angle_max: 40.0,
        angle_increment: 3.0,
        ..fields()
    };
    let remarks = bad.checked(0.1).unwrap_err();
    assert!(remarks.contains("neither gives a sweep"), "{remarks}");
    // A turn and a third: as degrees it would be a view of 8°.
    let bad = ScanFields {
        angle_max: -PI + 8.38,
        angle_increment: 8.38 / 359.0,
        ..fields()
    };
    let remarks = bad.checked(0.1).unwrap_err();
    assert!(
        remarks.contains("cover 480°, more than a turn; correct angle_min"),
        "{remarks}"
    );
    let bad = ScanFields {
        angle_max: -PI + 3.0 * TAU - TAU / 120.0,
        angle_increment: TAU / 120.0,
        ..fields()
    };
    let remarks = bad.checked(0.1).unwrap_err();
    assert!(
        remarks.ends_with("publish each of its 3 revolutions as a scan"),
        "{remarks}"
    );
    let bad = ScanFields {
        angle_max: f64::NAN,
        angle_increment: f64::NAN,
        ..fields()
    };
    assert!(
        bad.checked(0.1)
            .unwrap_err()
            .contains("set it in the driver")
    );
}

#[test]
fn the_time_of_a_beam_is_checked_against_the_period() {
    let interval = |time_increment: f64| {
        let fields = ScanFields {
            time_increment,
            ..fields()
        };
        let (scan, remarks) = fields.checked(0.1).unwrap();
        (scan.beam_interval_s, remarks.join(" "))
    };
    assert_eq!(interval(0.1 / 360.0), (0.1 / 360.0, String::new()));
    let (taken_s, remarks) = interval(0.1e9 / 360.0);
    assert!(
        (taken_s - 0.1 / 360.0).abs() < 1e-9 && remarks.contains("nanoseconds"),
        "{remarks}"
    );
    let (taken_s, remarks) = interval(7.0);
    assert!(
        taken_s == 0.0 && remarks.ends_with("Correct time_increment in the driver"),
        "{remarks}"
    );
    // Three periods in one sweep are no unit: the stamps come too fast.
    let (taken_s, remarks) = interval(0.3 / 360.0);
    assert!(
        taken_s == 0.0 && remarks.contains("3.0 times the 0.10 s between stamps"),
        "{remarks}"
    );
}

#[test]
fn millimetres_are_divided() {
    let fields = ScanFields {
        ranges_m: vec![2000.0; 360],
        ..fields()
    };
    let (scan, remarks) = fields.checked(0.1).unwrap();
    assert_eq!((scan.ranges_m[0], scan.range_max_m), (2.0, 12.0));
    assert!(remarks[0].contains("millimetres"));
}
