//! Each fault of a stream's stamps, and its correction.

use super::*;

/// Twenty messages a second, recorded 2 ms later.
fn stream(count: usize) -> (Vec<f64>, Vec<f64>) {
    let stamps: Vec<f64> = (0..count).map(|k| 100.0 + 0.05 * k as f64).collect();
    let recorded = stamps.iter().map(|stamp_s| stamp_s + 0.002).collect();
    (stamps, recorded)
}

#[track_caller]
fn assert_near(mended: &MendedStamps, expected: &[f64], within_s: f64) {
    for (at, (stamp_s, expected_s)) in mended.stamps_s.iter().zip(expected).enumerate() {
        assert!(
            (stamp_s - expected_s).abs() <= within_s,
            "{at}: {stamp_s} {expected_s}"
        );
    }
}

#[test]
fn good_stamps_stay_as_they_are_through_a_pause_and_with_late_recording() {
    let (mut stamps, mut recorded) = stream(60);
    for k in 30..60 {
        stamps[k] += 50.0;
        recorded[k] += 50.0;
    }
    // The recorder was delayed for a while.
    for recorded_s in &mut recorded[10..16] {
        *recorded_s += 3.0;
    }
    let none = vec![f64::NAN; 60];
    for recorded in [&recorded, &stamps, &none] {
        let mended = MendedStamps::new(&stamps, recorded);
        assert!(mended.is_unchanged(), "{:?}", mended.steps);
        assert_eq!(mended.stamps_s, stamps);
        assert!((mended.period_s - 0.05).abs() < 1e-9);
    }
}

#[test]
fn single_outlier_stamps_are_replaced() {
    for off_s in [1e6, -1e6, 30.0, -3.0] {
        for at in [0, 1, 20, 58, 59] {
            let (good, recorded) = stream(60);
            let mut stamps = good.clone();
            stamps[at] += off_s;
            let mended = MendedStamps::new(&stamps, &recorded);
            assert_eq!(mended.outliers + mended.unset, 1, "{off_s} {at}");
            assert_near(&mended, &good, 1e-6);
            if at > 0 && at < 58 {
                let alone = MendedStamps::new(&stamps, &vec![f64::NAN; 60]);
                assert_near(&alone, &good, 1e-6);
            }
        }
    }
}

#[test]
fn stamps_of_zero_are_those_of_the_recording() {
    let (good, recorded) = stream(30);
    let mended = MendedStamps::new(&[0.0; 30], &recorded);
    assert_eq!((mended.unset, &mended.stamps_s), (30, &recorded));
    let mut some = good.clone();
    some[7] = 0.0;
    let mended = MendedStamps::new(&some, &recorded);
    assert_eq!(mended.unset, 1);
    assert_near(&mended, &good, 1e-6);
}

#[test]
fn clock_steps_are_removed() {
    for by_s in [-100.0, 3600.0, -1.5] {
        let (good, recorded) = stream(60);
        let mut stamps = good.clone();
        stamps[33..].iter_mut().for_each(|stamp_s| *stamp_s += by_s);
        let mended = MendedStamps::new(&stamps, &recorded);
        assert_eq!(mended.steps.len(), 1, "{by_s}");
        assert_eq!(mended.steps[0].at, 33);
        assert_near(&mended, &good, 1e-6);
    }
    // Without the time of recording, only a step back shows.
    let (good, _) = stream(60);
    let mut stamps = good.clone();
    stamps[33..]
        .iter_mut()
        .for_each(|stamp_s| *stamp_s -= 100.0);
    let mended = MendedStamps::new(&stamps, &vec![f64::NAN; 60]);
    assert_near(&mended, &good, 1e-6);
}

#[test]
fn swapped_neighbours_keep_their_stamps() {
    let (mut stamps, recorded) = stream(40);
    for pair in stamps.chunks_exact_mut(2) {
        pair.swap(0, 1);
    }
    let mended = MendedStamps::new(&stamps, &recorded);
    assert!(mended.is_unchanged());
    assert_eq!((mended.swapped, &mended.stamps_s), (20, &stamps));
}

#[test]
fn coarse_stamps_are_spread_in_their_order() {
    let stamps: Vec<f64> = (0..40)
        .map(|k| 1.13486e9 + if k < 25 { 0.0 } else { 1e4 })
        .collect();
    let mended = MendedStamps::new(&stamps, &[f64::NAN; 40]);
    assert_eq!(mended.equal, 38);
    assert!(mended.stamps_s.windows(2).all(|two| two[0] < two[1]));
    // Ten per second in whole seconds.
    let stamps: Vec<f64> = (0..40).map(|k| f64::from(100 + k / 10)).collect();
    let mended = MendedStamps::new(&stamps, &[f64::NAN; 40]);
    let expected: Vec<f64> = (0..30).map(|k| 100.0 + 0.1 * f64::from(k)).collect();
    assert_near(&mended, &expected, 1e-9);
}

#[test]
fn one_stamp_for_all_messages_is_replaced_by_their_times_of_recording() {
    let (stamps, recorded) = stream(60);
    let same = vec![stamps[0]; 60];
    let mended = MendedStamps::new(&same, &recorded);
    assert_near(&mended, &recorded, 1e-9);
    assert_eq!(
        (mended.only_s, mended.unset, mended.equal),
        (Some(stamps[0]), 0, 0)
    );
    let said = &mended.remarks("scans")[0].text;
    assert!(
        said.starts_with("all 60 scans have the same stamp, 100.00 s"),
        "{said}"
    );
    // Without times of recording, they can only be spread.
    assert_eq!(MendedStamps::new(&same, &[]).only_s, None);
    // A duplicate is no fault.
    assert_eq!(MendedStamps::new(&same[..2], &recorded[..2]).only_s, None);
}
