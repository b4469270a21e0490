//! The findings of the comparison, a sentence each.

use core::f64::consts::PI;

use super::{Costs, Finding, MotionComparison, OdometryUse, Suggestion};
use crate::laser_mount::LaserMount;
use crate::remark::{NO_ODOMETRY, Part, Remark};

/// A lag is the time of a sweep to within this share of it: the lag is found to a few hundredths of a second.
const SAME_SWEEP: f64 = 0.35;

impl MotionComparison {
    /// The findings, one remark each; `mount` is the stated mounting, and `is_mount_fixed` whether the user set it, so
    /// that it was not corrected.
    #[must_use]
    pub fn remarks(&self, mount: LaserMount, is_mount_fixed: bool) -> Vec<Remark> {
        let mended = self.repairs(mount, false).mount().unwrap_or(mount);
        let found = self.findings().iter().map(|(finding, costs)| {
            let text = format!("{}{}", sentence(finding), by_trial(*costs));
            let remark = match finding {
                Finding::Mirrored { .. } | Finding::Turned { .. } => {
                    of_mount(finding, text, mount, mended, is_mount_fixed)
                }
                Finding::Unit { .. } => Remark::mended(
                    Part::Odometry,
                    format!("{text}; it was converted. Publish metres"),
                ),
                Finding::Opposed { .. } => Remark::mended(
                    Part::Odometry,
                    format!("{text}; it was reversed. Correct the sign in the driver"),
                ),
                Finding::TurnScale { .. } => Remark::mended(
                    Part::Odometry,
                    format!(
                        "{text}; its turns were scaled by that. Correct the distance between the wheels in the driver"
                    ),
                ),
                Finding::Backward => Remark::mended(
                    Part::Sensor,
                    format!(
                        "{text}; their times were reversed. List the beams in the order in which they are measured, with the matching sign of angle_increment"
                    ),
                ),
                Finding::Still { .. } => Remark::mended(
                    Part::Odometry,
                    format!("{text}; it is ignored and scans are matched alone. Check its topic"),
                ),
                Finding::Scale { .. } => Remark::wrong(
                    Part::Odometry,
                    format!("{text}; check the wheel radius, or use scans alone with {NO_ODOMETRY}"),
                ),
                Finding::Unlike { .. } => Remark::wrong(
                    Part::Odometry,
                    format!("{text}; it may not be this robot's, or its heading may be in degrees: use scans alone with {NO_ODOMETRY}"),
                ),
                Finding::Swept { .. } => Remark::mended(
                    Part::Sensor,
                    format!(
                        "{text} with the odometry late; the time between beams was set to that. Publish one revolution per scan, stamped at its first beam, or state the time between beams"
                    ),
                ),
                Finding::Late { by_s } => Remark::mended(
                    Part::Clocks,
                    format!(
                        "{text}; it was shifted by that{}. Synchronize both clocks with NTP, and stamp each message when it is measured",
                        self.at_last_beam(*by_s)
                    ),
                ),
            };
            match finding {
                Finding::Unit { .. }
                | Finding::Opposed { .. }
                | Finding::TurnScale { .. }
                | Finding::Still { .. } => {
                    remark.with_option(OdometryUse::Force.option())
                }
                Finding::Scale { .. } | Finding::Unlike { .. } => remark.with_option(NO_ODOMETRY),
                _ => remark,
            }
        });
        // Scans that cannot be matched alone differ from odometry: that says nothing about it.
        let is_said =
            |suggestion: &&Suggestion| !matches!(suggestion.finding, Finding::Unlike { .. });
        let suggested = self.suggestions().iter().filter(is_said);
        let suggested = suggested.map(|suggestion| suggest(suggestion, mount));
        let long = self.long_sweep.map(|share| {
            let text = format!(
                "a sweep takes {share:.1} times the time between two scans, so each scan has beams of the ones before: publish one revolution per scan, stamped at its first beam, or correct the time between beams"
            );
            Remark::wrong(Part::Sensor, text)
        });
        found.chain(suggested).chain(long).collect()
    }

    /// What a lag of odometry of minus the time of a sweep also means.
    fn at_last_beam(&self, by_s: f64) -> String {
        let is_sweep =
            self.sweep_s > 0.0 && (by_s + self.sweep_s).abs() <= SAME_SWEEP * self.sweep_s;
        if !is_sweep {
            return String::new();
        }
        format!(
            ". A sweep takes {:.2} s, so the scans may be stamped at their last beam: stamp them at the first, because each pose is where its first beam was measured",
            self.sweep_s
        )
    }
}

/// A fault of the mounting.
fn of_mount(
    finding: &Finding,
    text: String,
    mount: LaserMount,
    mended: LaserMount,
    is_mount_fixed: bool,
) -> Remark {
    let (option, own) = (mended.option(), mount.option());
    let otherwise = OdometryUse::Mirrored.option();
    let is_mirrored = matches!(finding, Finding::Mirrored { .. });
    let causes = if is_mirrored {
        format!(". {}", causes(&option))
    } else {
        String::new()
    };
    let remark = if is_mount_fixed {
        Remark::wrong(
            Part::Mounting,
            format!("{text}{causes}; correct it with {option}"),
        )
        .with_option(option)
    } else {
        Remark::mended(
            Part::Mounting,
            format!(
                "{text}{causes}; it was corrected; keep the correction with {option}, or the recording's mounting with {own}"
            ),
        )
        .with_option(option)
        .with_option(own)
    };
    if is_mirrored {
        remark.with_option(otherwise)
    } else {
        remark
    }
}

/// What mirrors scans, with what corrects it; `option` turns the laser over.
fn causes(option: &str) -> String {
    format!(
        "The laser is mounted upside down, or its driver lists the beams clockwise (both: {option}), or the odometry counts turns clockwise ({})",
        OdometryUse::Mirrored.option()
    )
}

/// What the comparison shows, without what was done.
fn sentence(finding: &Finding) -> String {
    match finding {
        Finding::Mirrored { correlation } => format!(
            "the scans are mirrored: they turn opposite to odometry (correlation {correlation:.2})"
        ),
        Finding::Turned { by_rad } => format!(
            "the laser faces {:.0}° away from its stated direction ({}), as the comparison of scans and odometry shows",
            by_rad.to_degrees().abs(),
            if by_rad.abs() > 0.8 * PI {
                "backward"
            } else if *by_rad > 0.0 {
                "to the left"
            } else {
                "to the right"
            },
        ),
        Finding::Unit { name, metres } => format!(
            "odometry is in {name}: it moves {:.0} per metre by scans",
            1.0 / metres
        ),
        Finding::Opposed { is_heading } => format!(
            "the path by odometry bends opposite to its headings: its {} has the wrong sign",
            if *is_heading { "heading" } else { "y" }
        ),
        Finding::TurnScale { ratio } => {
            format!("odometry turns by {ratio:.2}° per degree by scans")
        }
        Finding::Backward => {
            "the beams are listed against the sense in which the sensor turns: the last one was measured first".to_owned()
        }
        Finding::Scale { ratio } => format!("odometry measures {ratio:.2} m per metre by scans"),
        Finding::Still { moved_m } => {
            format!("odometry stands still while the scans move by {moved_m:.1} m")
        }
        Finding::Unlike { correlation } => format!(
            "the turns of scans matched alone and of odometry differ (correlation {correlation:.2})"
        ),
        Finding::Swept { share, .. } => format!(
            "a sweep takes about {share:.0} times the time between two scans, although its beams have no times, so each scan has beams of the ones before"
        ),
        Finding::Late { by_s } => format!(
            "odometry is {:.2} s {} relative to the scans, judging by the turns of both",
            by_s.abs(),
            if *by_s > 0.0 { "late" } else { "early" }
        ),
    }
}

/// The result of a trial.
fn by_trial(costs: Option<Costs>) -> String {
    costs.map_or(String::new(), |costs| {
        format!(
            ", and the first {} scans cost {:.1} nats each with the repair, {:.1} without",
            costs.scans, costs.with, costs.without
        )
    })
}

/// A finding that the trial refuted: nothing was changed.
fn suggest(suggestion: &Suggestion, mount: LaserMount) -> Remark {
    let Suggestion { finding, costs } = suggestion;
    let mut mended = mount;
    finding.mend(&mut mended);
    let (part, option) = match finding {
        Finding::Mirrored { .. } | Finding::Turned { .. } => {
            (Part::Mounting, Some(mended.option()))
        }
        Finding::Late { .. } => (Part::Clocks, None),
        Finding::Unit { .. } | Finding::Opposed { .. } | Finding::TurnScale { .. } => {
            (Part::Odometry, None)
        }
        Finding::Backward | Finding::Swept { .. } => (Part::Sensor, None),
        Finding::Scale { .. } | Finding::Still { .. } | Finding::Unlike { .. } => {
            (Part::Odometry, Some(NO_ODOMETRY.to_owned()))
        }
    };
    let alone = format!("use scans alone with {NO_ODOMETRY}");
    let remedy = match (finding, &option) {
        (Finding::Mirrored { .. }, Some(option)) => causes(option),
        (Finding::Opposed { .. }, _) => format!("Correct the sign in the driver, or {alone}"),
        (Finding::TurnScale { .. }, _) => {
            format!("Correct the distance between the wheels in the driver, or {alone}")
        }
        (Finding::Unit { .. }, _) => format!("State the unit, or {alone}"),
        (Finding::Late { .. }, _) => "Synchronize both clocks with NTP".to_owned(),
        (_, Some(option)) => format!("Compare with a map made with {option}"),
        (_, None) => "Compare with the driver's settings".to_owned(),
    };
    let text = format!(
        "scans matched alone suggest that {}, but a map of the first {} scans is not clearly better in both halves after that repair ({:.1} nats per scan, {:.1} without), so nothing was changed. {remedy}",
        sentence(finding),
        costs.scans,
        costs.with,
        costs.without
    );
    let remark = Remark::mended(part, text);
    match option {
        Some(option) => remark.with_option(option),
        None => remark,
    }
}
