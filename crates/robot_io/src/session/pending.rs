//! A loop that waits for confirmation.

use ch16_slam2d::loops::{GateTest, LoopCandidate, LoopVerification, PendingLoop};
use pr_geom::Vector3;

use super::bytes::{Broken, Cursor, Writer};

/// Least bytes of one.
pub const BYTES: usize = 300;

pub fn write(pending: &PendingLoop, out: &mut Writer) {
    let PendingLoop {
        verification,
        path_m,
        is_expected,
    } = pending;
    let LoopVerification {
        from_node,
        candidate,
        belief,
        initial,
        registered,
        rmse_m,
        inliers,
        iterations,
        score,
        margin,
        innovation,
        gate_information,
        gate,
        information,
        // Only a loop that passed all other tests is pending.
        rejection: _,
    } = verification;
    let LoopCandidate {
        node,
        distance_m,
        proposal,
    } = candidate;
    let GateTest { chi2, gate_chi2 } = gate;
    out.f64(*path_m);
    out.u8(u8::from(*is_expected));
    out.count(*from_node);
    out.count(*node);
    out.f64(*distance_m);
    out.maybe(proposal.as_ref(), Writer::pose);
    [belief, initial, registered]
        .into_iter()
        .for_each(|pose| out.pose(pose));
    out.f64(*rmse_m);
    out.count(*inliers);
    out.count(*iterations);
    out.maybe(*score, Writer::f64);
    out.maybe(*margin, Writer::f64);
    innovation.iter().for_each(|value| out.f64(*value));
    out.matrix(gate_information);
    out.f64(*chi2);
    out.f64(*gate_chi2);
    out.matrix(information);
}

pub fn read(from: &mut Cursor<'_>) -> Result<PendingLoop, Broken> {
    let path_m = from.number()?;
    let is_expected = from.flag()?;
    let from_node = from.u32()? as usize;
    let candidate = LoopCandidate {
        node: from.u32()? as usize,
        distance_m: from.f64()?,
        proposal: from.maybe(Cursor::pose)?,
    };
    let verification = LoopVerification {
        from_node,
        candidate,
        belief: from.pose()?,
        initial: from.pose()?,
        registered: from.pose()?,
        rmse_m: from.f64()?,
        inliers: from.u32()? as usize,
        iterations: from.u32()? as usize,
        score: from.maybe(Cursor::f64)?,
        margin: from.maybe(Cursor::f64)?,
        innovation: Vector3::new(from.number()?, from.number()?, from.number()?),
        gate_information: from.matrix()?,
        gate: GateTest {
            chi2: from.f64()?,
            gate_chi2: from.f64()?,
        },
        information: from.matrix()?,
        rejection: None,
    };
    Ok(PendingLoop {
        verification,
        path_m,
        is_expected,
    })
}
