use super::*;
use crate::lap::{LapRunner, LoopJudgement};

fn record() -> LapRecord {
    LapRunner::new().run(&LapConfig::default())
}

const REQUEST: OwnLoopRequest = OwnLoopRequest {
    tick: 129,
    nodes: [40, 3],
    claim: Claim::Registered,
    gate: GateUse::Asked,
    kernel: OwnKernel::Quadratic,
};

#[test]
fn the_strains_of_all_edges_add_up_to_the_chi_squared_of_the_graph() {
    let record = record();
    for tick in [30, 92, 129] {
        let edges = record.lap.edges(tick).iter();
        let poses = record.lap.poses(tick);
        let sum: f64 = edges.map(|edge| edge_strain(edge, poses).chi2).sum();
        let chi2 = record.lap.graph(tick).chi2();
        // 1e-9: the two subtract the headings in another order.
        assert!((sum - chi2).abs() < 1e-9 * (1.0 + chi2), "{sum} and {chi2}");
    }
}

/// A wrong loop without gate: keyframe 40 is 5.9 m from keyframe 12, at the end of the lap.
const WRONG: OwnLoopRequest = OwnLoopRequest {
    nodes: [12, 40],
    claim: Claim::SamePlace,
    gate: GateUse::Bypassed,
    ..REQUEST
};

fn effect(record: &LapRecord, request: OwnLoopRequest) -> RecordedLoopEffect {
    record.own_loop(&request).unwrap().attempt.effect.unwrap()
}

#[test]
fn the_gate_rejects_a_wrong_loop_and_can_be_bypassed() {
    let record = record();
    let asked = OwnLoopRequest {
        gate: GateUse::Asked,
        ..WRONG
    };
    let rejected = record.own_loop(&asked).unwrap();
    let rejection = rejected.attempt.verification.rejection;
    assert!(matches!(rejection, Some(LoopRejection::OutsideGate(_))));
    assert_eq!(rejected.poses, record.lap.poses(129));
    let forced = record.own_loop(&WRONG).unwrap();
    assert_eq!(
        record.lap.judge(&forced.attempt),
        LoopJudgement::FalseAcceptance
    );
    assert!(effect(&record, WRONG).max_shift_m > 3.0);
}

#[test]
fn huber_softens_a_wrong_loop_and_dcs_switches_it_off() {
    let record = record();
    let moved = |kernel| effect(&record, OwnLoopRequest { kernel, ..WRONG }).max_shift_m;
    let [quadratic, huber, dcs] =
        [OwnKernel::Quadratic, OwnKernel::Huber, OwnKernel::Dcs].map(moved);
    assert!(huber < quadratic, "{huber} and {quadratic}");
    // Its weight is (2φ / (φ + χ²))² with χ² of 14 thousand: two millionths.
    assert!(dcs < 0.001, "{dcs}");
}

#[test]
fn a_kernel_hardly_changes_a_right_loop() {
    let record = record();
    let request = OwnLoopRequest {
        nodes: [0, 25],
        claim: Claim::Truth,
        ..WRONG
    };
    for kernel in [OwnKernel::Huber, OwnKernel::Dcs] {
        let with = effect(&record, OwnLoopRequest { kernel, ..request });
        let without = effect(&record, request);
        let off = (with.max_shift_m - without.max_shift_m).abs();
        // Below its width a kernel is quadratic, so only the tolerance of the reweighting remains.
        assert!(off < 1e-3, "{kernel:?}: {off}");
    }
}

#[test]
fn what_a_wrong_loop_bends_is_seen_in_the_strains() {
    let record = record();
    let own = record.own_loop(&WRONG).unwrap();
    let edges = || record.lap.edges(129).iter().chain([&own.edge]);
    let sum = |poses: &[SE2]| {
        edges()
            .map(|edge| edge_strain(edge, poses).chi2)
            .sum::<f64>()
    };
    let chi2 = own.attempt.effect.unwrap().chi2;
    let before = sum(record.lap.poses(129));
    // 1e-9: the two subtract the headings in another order.
    assert!((before - chi2.before).abs() < 1e-9 * before);
    assert!((sum(&own.poses) - chi2.after).abs() < 1e-9 * chi2.after);
    // The loop's error is mostly resolved, at the cost of the other edges.
    assert!(edge_strain(&own.edge, &own.poses).chi2 < 0.1 * chi2.after);
}

#[test]
fn a_true_loop_to_the_far_end_mends_the_corridor_that_no_gate_lets_be_mended() {
    let record = record();
    let request = OwnLoopRequest {
        nodes: [0, 25],
        claim: Claim::Truth,
        gate: GateUse::Asked,
        ..REQUEST
    };
    let asked = record.own_loop(&request).unwrap();
    assert!(
        !asked.is_closed(),
        "the corridor is almost a metre too short"
    );
    let rms = effect(
        &record,
        OwnLoopRequest {
            gate: GateUse::Bypassed,
            ..request
        },
    )
    .keyframe_rms_m;
    assert!(rms.after < 0.25 * rms.before, "{rms:?}");
}

#[test]
fn a_registered_loop_of_the_lap_is_found_again_as_the_lap_found_it() {
    // A rejected loop leaves the graph as it was.
    let noisy = LapRunner::new().run(&LapConfig::with_seed_and_noise(2, 3.0));
    let rejected = noisy
        .lap
        .loop_attempts()
        .find(|attempt| !attempt.accepted());
    let rejected = rejected.expect("this lap is locked out");
    let loop_ = &rejected.verification;
    let own = noisy
        .own_loop(&OwnLoopRequest {
            tick: rejected.tick,
            nodes: [loop_.from_node, loop_.candidate.node],
            ..REQUEST
        })
        .unwrap();
    assert_eq!(own.attempt.verification.registered, loop_.registered);
    assert_eq!(own.attempt.verification.gate, loop_.gate);
    assert_eq!(own.attempt.verification.rejection, loop_.rejection);
}

#[test]
fn ends_that_cannot_be_are_rejected_in_a_sentence() {
    let record = record();
    for (nodes, tick, words) in [
        (
            [7, 7],
            129,
            "both ends of your loop are keyframe 7: choose two different ones",
        ),
        (
            [40, 3],
            92,
            "keyframe 40 does not exist yet; keyframe 29 is the newest",
        ),
        (
            [3, 999],
            129,
            "keyframe 999 does not exist yet; keyframe 40 is the newest",
        ),
    ] {
        let request = OwnLoopRequest {
            nodes,
            tick,
            ..REQUEST
        };
        let error = record.own_loop(&request).unwrap_err();
        assert_eq!(error.to_string(), words);
    }
}
