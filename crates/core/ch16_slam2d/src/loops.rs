//! Loop closure: which old keyframes might show the same location, whether the sweeps agree, and
//! whether the result is plausible.
//!
//! A [`LoopDetector`] proposes, [`verify_loop`] registers and tests; the two are independent. Three tests guard
//! the graph, because a false loop far from the truth wrecks it: the registration has to fit (`rmse`), enough points have to be
//! paired (`inliers`), and the innovation `ξ = log(T₀⁻¹ T̂)` between the graph's relative pose T₀ and the
//! registered T̂ has to lie within the possible drift of the odometry between the two nodes: `ξᵀ S⁻¹ ξ ≤ χ²`.
//!
//! The gate cannot distinguish two poses that are both within the drift, and it rejects a true loop if the drift
//! was larger than assumed.

mod candidates;
mod config;
mod detector;
mod gate;
mod pending_loop;
mod verify;

pub use candidates::{LoopCandidate, detect_loop_candidates, detect_visits};
pub use config::{GateModel, LoopConfig};
pub use detector::{CloneDetector, LoopDetector, LoopQuery, NearbyDetector};
pub use gate::{GateTest, InnovationGate, chi_squared_gate};
pub use pending_loop::PendingLoop;
pub use verify::{
    Agreement, KeyframeView, LoopRejection, LoopVerification, LoopWorkspace, verify_loop,
};
