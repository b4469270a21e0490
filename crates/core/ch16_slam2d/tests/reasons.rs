//! The text of every reason to stop or to reject.

use ch16_slam2d::graph::MarginalizeError;
use ch16_slam2d::icp::StopReason;
use ch16_slam2d::localize::Verdict;
use ch16_slam2d::loops::{Agreement, GateTest, LoopRejection};
use ch16_slam2d::matching::MatchStop;
use ch16_slam2d::ndt::NdtStop;
use ch16_slam2d::scan::FrameError;
use ch16_slam2d::search::SearchError;
use pr_optim::robust::GncStop;

#[test]
fn every_reason_states_its_values() {
    let small_step = StopReason::SmallStep {
        step: 0.5e-4,
        tolerance: 1e-4,
    };
    let gradient = NdtStop::SmallGradient {
        gradient: 2e-7,
        tolerance: 1e-6,
    };
    let gate = GateTest {
        chi2: 20.0,
        gate_chi2: 7.815,
    };
    let texts = [
        (small_step.to_string(), "step 5.00e-5 below 1.00e-4"),
        (MatchStop::Icp(small_step).to_string(), "ICP: step 5.00e-5"),
        (
            MatchStop::Ndt(gradient).to_string(),
            "NDT: gradient 2.00e-7",
        ),
        (MatchStop::Searched { poses: 9 }.to_string(), "9 poses"),
        (
            LoopRejection::OutsideGate(gate).to_string(),
            "chi-squared 20.0 is above 7.8",
        ),
        (
            Agreement {
                agreeing: 1,
                needed: 2,
            }
            .to_string(),
            "1 loops agree, 2 are needed",
        ),
        (format!("{:>9}", Verdict::Lost), "     lost"),
        (GncStop::RoundLimit.to_string(), "limit of rounds"),
        (SearchError::EmptyScan.to_string(), "no finite points"),
        (MarginalizeError::Fixed(3).to_string(), "node 3 is fixed"),
        (
            FrameError::Odometry { stamp_s: 1.5 }.to_string(),
            "frame at 1.5 s",
        ),
    ];
    for (text, expected) in texts {
        assert!(text.contains(expected), "{text}");
    }
}
