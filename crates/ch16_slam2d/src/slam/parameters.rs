//! The numbers of a [`SlamConfig`] by name, so that each can be varied and its effect measured.

use thiserror::Error;

use super::SlamConfig;
use crate::loops::{LoopGuard, WideSearch};
use crate::matching::{MatcherKind, StagedMatcherConfig};

/// Where a number stands.
#[derive(Debug)]
pub enum Slot<'a> {
    /// A real number.
    Real(&'a mut f64),
    /// A count.
    Count(&'a mut usize),
}

impl<'a> From<&'a mut f64> for Slot<'a> {
    fn from(value: &'a mut f64) -> Self {
        Self::Real(value)
    }
}

impl<'a> From<&'a mut usize> for Slot<'a> {
    fn from(value: &'a mut usize) -> Self {
        Self::Count(value)
    }
}

/// A number of the configuration.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its fields, joined by points.
    pub name: &'static str,
    /// Its unit; empty for counts and shares.
    pub unit: &'static str,
    /// What it does, in a few words.
    pub about: &'static str,
    at: fn(&mut SlamConfig) -> Option<Slot<'_>>,
}

/// Why a number was not set.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ParameterError {
    /// No parameter has that name.
    #[error("there is no parameter {0}")]
    Unknown(String),
    /// The configuration has another matcher, or does without the search.
    #[error("{0} has no meaning in this configuration")]
    Absent(&'static str),
    /// It is not a number that the parameter can take.
    #[error("{name} has to be a finite number that is not negative, not {value}")]
    Range {
        /// The parameter.
        name: &'static str,
        /// What it should have become.
        value: f64,
    },
}

impl Parameter {
    /// The parameter of that name.
    ///
    /// # Errors
    /// Where there is none.
    pub fn named(name: &str) -> Result<&'static Self, ParameterError> {
        let found = PARAMETERS.iter().find(|parameter| parameter.name == name);
        found.ok_or_else(|| ParameterError::Unknown(name.to_owned()))
    }

    /// Its value; none where the configuration has no use for it.
    #[must_use]
    pub fn value(&self, config: &SlamConfig) -> Option<f64> {
        let mut config = config.clone();
        (self.at)(&mut config).map(|slot| match slot {
            Slot::Real(value) => *value,
            Slot::Count(count) => *count as f64,
        })
    }

    /// Whether it is a number for a parameter.
    ///
    /// # Errors
    /// Where it is negative or not finite.
    pub fn check(&self, value: f64) -> Result<(), ParameterError> {
        let name = self.name;
        match value.is_finite() && value >= 0.0 {
            true => Ok(()),
            false => Err(ParameterError::Range { name, value }),
        }
    }

    /// Sets it; a count is rounded.
    ///
    /// # Errors
    /// Where the configuration has no use for it, or the value is no number for it.
    pub fn set(&self, config: &mut SlamConfig, value: f64) -> Result<(), ParameterError> {
        self.check(value)?;
        let name = self.name;
        match (self.at)(config).ok_or(ParameterError::Absent(name))? {
            Slot::Real(slot) => *slot = value,
            Slot::Count(slot) => *slot = value.round() as usize,
        }
        Ok(())
    }
}

fn staged(matcher: &mut MatcherKind) -> Option<&mut StagedMatcherConfig> {
    match matcher {
        MatcherKind::Staged(config) => Some(config),
        _ => None,
    }
}

fn search(config: &mut SlamConfig) -> Option<&mut WideSearch> {
    config.loops.search.as_mut()
}

fn guard(config: &mut SlamConfig) -> Option<&mut LoopGuard> {
    config.loops.guard.as_mut()
}

/// A field by its path.
macro_rules! field {
    ($($path:tt).+, $unit:literal, $about:literal) => {
        Parameter {
            name: stringify!($($path).+),
            unit: $unit,
            about: $about,
            at: |config| Some(Slot::from(&mut config.$($path).+)),
        }
    };
}

/// A field of a matcher or of the search, which a configuration may do without.
macro_rules! part {
    ($name:literal, $unit:literal, $about:literal, $at:expr) => {
        Parameter {
            name: $name,
            unit: $unit,
            about: $about,
            at: $at,
        }
    };
}

/// Every number of [`SlamConfig::for_robot`]; its fields say more.
pub const PARAMETERS: &[Parameter] = &[
    field!(
        scan.cell_m,
        "m",
        "one point of a scan is kept in each cell of this width"
    ),
    field!(
        scan.normal_radius_m,
        "m",
        "points this near give a point its normal"
    ),
    part!(
        "matcher.taus_m[0]",
        "m",
        "pairs at most this far apart, first stage of registration",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.taus_m[0]))
    ),
    part!("matcher.taus_m[1]", "m", "the same, second stage", |c| {
        staged(&mut c.matcher).map(|m| Slot::from(&mut m.taus_m[1]))
    }),
    part!("matcher.taus_m[2]", "m", "the same, last stage", |c| {
        staged(&mut c.matcher).map(|m| Slot::from(&mut m.taus_m[2]))
    }),
    part!(
        "matcher.huber_width_m",
        "m",
        "pairs farther apart than this weigh less",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.huber_width_m))
    ),
    part!(
        "matcher.fit_m",
        "m",
        "a point this near to the map fits",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.fit_m))
    ),
    part!(
        "matcher.good_score",
        "",
        "with less of the scan fitting, other starts are tried",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.good_score))
    ),
    part!(
        "matcher.cells_m[0]",
        "m",
        "cells of the wide Gaussians for other starts",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.cells_m[0]))
    ),
    part!("matcher.cells_m[1]", "m", "cells of the narrow ones", |c| {
        staged(&mut c.matcher).map(|m| Slot::from(&mut m.cells_m[1]))
    }),
    part!(
        "matcher.min_points",
        "",
        "points that such a cell needs",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.min_points))
    ),
    part!(
        "matcher.ndt_iterations",
        "",
        "iterations on such cells",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.ndt_iterations))
    ),
    part!(
        "matcher.turns",
        "",
        "other headings tried on either side",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.turns))
    ),
    part!(
        "matcher.lead",
        "",
        "by so much another start has to fit better",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.lead))
    ),
    part!(
        "matcher.near_score",
        "",
        "with this score of the last stage alone, no other is made",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.near_score))
    ),
    part!(
        "matcher.near_lead",
        "",
        "else all stages have to fit better by so much",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.near_lead))
    ),
    part!(
        "matcher.turn_rad",
        "rad",
        "from one of these headings to the next",
        |c| staged(&mut c.matcher).map(|m| Slot::from(&mut m.turn_rad))
    ),
    field!(window_sweeps, "", "scans in the local map"),
    field!(
        window_distance_m,
        "m",
        "a scan joins the local map after this way"
    ),
    field!(window_turn_rad, "rad", "or after this turn"),
    field!(
        local_map.cell_m,
        "m",
        "cells in which the local map looks up neighbours"
    ),
    field!(local_map.max_per_cell, "", "points that such a cell keeps"),
    field!(
        max_iterations,
        "",
        "iterations of each stage of registration"
    ),
    field!(
        min_inliers,
        "",
        "with fewer pairs a registration is not believed"
    ),
    field!(
        extrapolation,
        "",
        "without wheels, the last velocity stays for so many intervals"
    ),
    field!(
        contradiction.chi2,
        "",
        "disagreement that scan and wheels both allow, squared norm"
    ),
    field!(
        contradiction.min_score,
        "",
        "a scan of which less fits is not believed against the wheels"
    ),
    field!(
        contradiction.lead,
        "",
        "and it has to fit better than at their pose by so much"
    ),
    field!(
        contradiction.jump_m,
        "m",
        "how far wheels jump, a standard deviation"
    ),
    field!(contradiction.jump_rad, "rad", "the same for the heading"),
    field!(
        contradiction.jump_cost,
        "",
        "for each standard deviation of a jump the scan has to fit better by so much"
    ),
    field!(
        contradiction.max_cost,
        "",
        "and at most by so much for all of them"
    ),
    field!(
        aperture,
        "",
        "share of the information across a wall that noise claims along it"
    ),
    field!(
        threshold.initial_m,
        "m",
        "reach of the pairs at the pose between scan and wheels"
    ),
    field!(
        threshold.min_motion_m,
        "m",
        "smaller corrections do not move the adaptive threshold"
    ),
    field!(
        threshold.max_range_m,
        "m",
        "range at which it counts a turn as a shift"
    ),
    field!(keyframe_distance_m, "m", "way between keyframes"),
    field!(keyframe_turn_rad, "rad", "turn between keyframes"),
    field!(
        odometry_trust.sigma_m,
        "m",
        "a point of a registration is off by so much"
    ),
    field!(
        odometry_trust.inflate,
        "",
        "its pairs count as so many times fewer"
    ),
    field!(
        confidence,
        "",
        "times the information that the trust above gives an edge, for all edges"
    ),
    field!(
        odometry_noise.floor_m,
        "m",
        "wheels: error of the position of any motion"
    ),
    field!(
        odometry_noise.per_metre,
        "",
        "wheels: error of the position for each metre"
    ),
    field!(
        odometry_noise.metre_per_rad,
        "m",
        "wheels: error of the position for each radian"
    ),
    field!(
        odometry_noise.floor_rad,
        "rad",
        "wheels: error of the heading of any motion"
    ),
    field!(
        odometry_noise.per_rad,
        "",
        "wheels: error of the heading for each radian"
    ),
    field!(
        odometry_noise.rad_per_metre,
        "rad",
        "wheels: error of the heading for each metre"
    ),
    field!(
        prediction_noise.floor_m,
        "m",
        "no wheels: error of the position of any motion"
    ),
    field!(
        prediction_noise.per_metre,
        "",
        "no wheels: error of the position for each metre"
    ),
    field!(
        prediction_noise.metre_per_rad,
        "m",
        "no wheels: error of the position for each radian"
    ),
    field!(
        prediction_noise.floor_rad,
        "rad",
        "no wheels: error of the heading of any motion"
    ),
    field!(
        prediction_noise.per_rad,
        "",
        "no wheels: error of the heading for each radian"
    ),
    field!(
        prediction_noise.rad_per_metre,
        "rad",
        "no wheels: error of the heading for each metre"
    ),
    field!(
        loops.radius_m,
        "m",
        "keyframes within this distance are tried as loops"
    ),
    field!(
        loops.min_gap_nodes,
        "",
        "and so many keyframes older at least"
    ),
    field!(
        loops.attempt_every_nodes,
        "",
        "loops are looked for at every so many keyframes"
    ),
    field!(loops.candidates_tried, "", "earlier visits tried at once"),
    field!(
        loops.submap_half_width,
        "",
        "keyframes on either side of a candidate in its map"
    ),
    field!(
        loops.submap.cell_m,
        "m",
        "cells in which that map looks up neighbours"
    ),
    field!(
        loops.submap.max_per_cell,
        "",
        "points that such a cell keeps"
    ),
    part!(
        "loops.matcher.good_score",
        "",
        "with less of the scan fitting, NDT is tried",
        |c| staged(&mut c.loops.matcher).map(|m| Slot::from(&mut m.good_score))
    ),
    field!(
        loops.max_iterations,
        "",
        "iterations of each stage of a loop's registration"
    ),
    field!(
        loops.min_tau_m,
        "m",
        "reach of a loop's pairs where the matcher has no stages"
    ),
    field!(
        loops.max_rmse_m,
        "m",
        "a loop that fits worse is turned away"
    ),
    field!(
        loops.min_inliers,
        "",
        "a loop with fewer pairs is turned away"
    ),
    field!(
        loops.min_score,
        "",
        "a loop of which less fits is turned away"
    ),
    field!(
        loops.trust.sigma_m,
        "m",
        "a point of a loop is off by so much"
    ),
    field!(
        loops.trust.inflate,
        "",
        "its pairs count as so many times fewer"
    ),
    field!(loops.aperture, "", "as the aperture, for loops"),
    field!(
        loops.drift_share,
        "",
        "drift that goes one way, for each metre since the last loop"
    ),
    field!(
        loops.max_radius_m,
        "m",
        "the radius grows with the drift up to this"
    ),
    part!(
        "loops.search.min_way_m",
        "m",
        "after this way without a loop the window is searched",
        |c| search(c).map(|s| Slot::from(&mut s.min_way_m))
    ),
    part!(
        "loops.search.every_m",
        "m",
        "and again so far after the last search",
        |c| search(c).map(|s| Slot::from(&mut s.every_m))
    ),
    part!(
        "loops.search.candidates",
        "",
        "keyframes around which it is searched",
        |c| search(c).map(|s| Slot::from(&mut s.candidates))
    ),
    part!(
        "loops.search.min_margin",
        "",
        "lead that the best place needs over any other",
        |c| search(c).map(|s| Slot::from(&mut s.min_margin))
    ),
    part!(
        "loops.search.min_score",
        "",
        "share of the scan that has to fit there",
        |c| search(c).map(|s| Slot::from(&mut s.min_score))
    ),
    part!(
        "loops.search.half_turn_rad",
        "rad",
        "headings searched on either side",
        |c| search(c).map(|s| Slot::from(&mut s.matcher.half_turn_rad))
    ),
    part!(
        "loops.guard.floor_m",
        "m",
        "the graph is off by so much more than it says",
        |c| guard(c).map(|g| Slot::from(&mut g.floor_m))
    ),
    part!(
        "loops.guard.floor_rad",
        "rad",
        "the same for the heading",
        |c| guard(c).map(|g| Slot::from(&mut g.floor_rad))
    ),
    part!(
        "loops.guard.gate_chi2",
        "",
        "the largest squared innovation that the graph expects",
        |c| guard(c).map(|g| Slot::from(&mut g.gate_chi2))
    ),
    part!(
        "loops.guard.sure_m",
        "m",
        "where the gate reaches farther, a loop waits for others",
        |c| guard(c).map(|g| Slot::from(&mut g.sure_m))
    ),
    part!(
        "loops.guard.min_margin",
        "",
        "and needs this lead over any other place",
        |c| guard(c).map(|g| Slot::from(&mut g.min_margin))
    ),
    part!(
        "loops.guard.agreeing",
        "",
        "loops that have to agree within the gate",
        |c| guard(c).map(|g| Slot::from(&mut g.agreeing))
    ),
    part!(
        "loops.guard.agreeing_outside",
        "",
        "loops that have to agree against the gate",
        |c| guard(c).map(|g| Slot::from(&mut g.agreeing_outside))
    ),
    part!(
        "loops.guard.apart_m",
        "m",
        "way between loops that agree",
        |c| guard(c).map(|g| Slot::from(&mut g.apart_m))
    ),
    part!(
        "loops.guard.patience_m",
        "m",
        "way on which a loop waits for others",
        |c| guard(c).map(|g| Slot::from(&mut g.patience_m))
    ),
    field!(
        loops.drift_sigma_m,
        "m",
        "drift of x and y over one keyframe, for the gate"
    ),
    field!(
        loops.drift_sigma_rad,
        "rad",
        "drift of the heading over one keyframe, for the gate"
    ),
    field!(
        loops.gate_chi2,
        "",
        "the largest squared innovation that is believed"
    ),
    field!(
        refinement.passes,
        "",
        "rounds of linking after the last scan"
    ),
    field!(
        refinement.radius_m,
        "m",
        "keyframes within this distance are linked"
    ),
    field!(
        refinement.min_gap_nodes,
        "",
        "and so many keyframes apart at least"
    ),
    field!(refinement.visits, "", "visits linked with a keyframe"),
    field!(
        refinement.shift_sigma_m,
        "m",
        "a link may move a keyframe by so much, for its gate"
    ),
    field!(refinement.turn_sigma_rad, "rad", "or turn it by so much"),
    field!(
        refinement.huber,
        "",
        "width of the last optimization's robust cost"
    ),
    field!(
        least_correction,
        "",
        "a loop that would move no keyframe farther, m and rad added, corrects the map with the next one"
    ),
    field!(
        optimizer_iterations,
        "",
        "steps of the optimizer after a loop"
    ),
    field!(
        optimizer_tolerance,
        "",
        "it ends where no keyframe moves farther, m and rad added"
    ),
    field!(huber, "", "width of its robust cost while scans come in"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::LaserScan;

    #[test]
    fn every_number_can_be_read_set_and_is_where_its_name_says() {
        let config = SlamConfig::for_robot(&LaserScan::default());
        for parameter in PARAMETERS {
            let before = parameter.value(&config).unwrap();
            let mut changed = config.clone();
            parameter.set(&mut changed, before + 1.0).unwrap();
            assert_eq!(
                parameter.value(&changed),
                Some(before + 1.0),
                "{}",
                parameter.name
            );
            let field = parameter.name.rsplit('.').next().unwrap();
            let field = field.split('[').next().unwrap();
            let (was, is) = (format!("{config:#?}"), format!("{changed:#?}"));
            let lines = was.lines().zip(is.lines());
            let differing: Vec<_> = lines.filter(|(a, b)| a != b).collect();
            assert_eq!(differing.len(), 1, "{}", parameter.name);
            let named = differing[0].0.trim_start().starts_with(field);
            assert!(
                named || parameter.name.contains('['),
                "{} {differing:?}",
                parameter.name
            );
        }
    }

    #[test]
    fn what_cannot_be_set_is_refused_in_a_sentence() {
        let mut chapter = SlamConfig::chapter();
        let error = Parameter::named("loops.search.min_way_m")
            .and_then(|parameter| parameter.set(&mut chapter, 1.0))
            .unwrap_err();
        let said = "loops.search.min_way_m has no meaning in this configuration";
        assert_eq!(error.to_string(), said);
        assert!(Parameter::named("radius").is_err());
        let huber = Parameter::named("huber").unwrap();
        assert!(huber.set(&mut chapter, f64::NAN).is_err());
        assert!(huber.set(&mut chapter, -1.0).is_err());
    }
}
