//! The loop of ICP, one iteration at a time or to the end.

use pr_geom::{SE2, math};
use serde::Serialize;

use super::align::Solved;
use super::{IcpConfig, IcpTrace, IcpWorkspace, Pair, PairRejection};
use crate::cloud::{NearestMap, PointCloud};

/// Why a registration ended, with the measured value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StopReason {
    /// The last increment was smaller than the tolerance: converged.
    SmallStep {
        /// `‖(v_x, v_y)‖ + |ω|` of the increment.
        step: f64,
        /// [`IcpConfig::tolerance`].
        tolerance: f64,
    },
    /// The limit of iterations was reached.
    IterationLimit {
        /// [`IcpConfig::max_iterations`].
        max_iterations: usize,
    },
    /// Too little of the cloud is near the map.
    TooFewPairs {
        /// Pairs at the last pose.
        pairs: usize,
        /// [`IcpConfig::min_pairs`].
        min_pairs: usize,
    },
    /// The increments became small, but too few of the pairs have a normal: the others exert no force in point to plane.
    TooFewNormals {
        /// Pairs with a normal at the last pose.
        normals: usize,
        /// All pairs there.
        pairs: usize,
        /// [`IcpConfig::min_normals`].
        min_normals: usize,
    },
    /// The increments became small, but the kernel takes nearly all pairs for outliers.
    TooFewInliers {
        /// Pairs with a residual up to the kernel's width.
        inliers: usize,
        /// [`IcpConfig::min_pairs`].
        min_pairs: usize,
        /// [`IcpConfig::huber_width_m`].
        width_m: f64,
    },
    /// The increments became small, but the pairs do not measure a direction, as along a corridor: along it the pose
    /// is that of the guess. The other directions converged.
    Unobservable {
        /// The motion `(t_x, t_y, ω)` that is not measured, about the centroid of the pairs, of unit length.
        direction: [f64; 3],
    },
    /// The next increment is not finite, as for points 1e200 m away; the pose is unchanged.
    NotFinite,
}

impl StopReason {
    /// Whether the increments became small, and the pairs measure every direction.
    #[must_use]
    pub fn converged(&self) -> bool {
        matches!(self, Self::SmallStep { .. })
    }

    /// Whether enough pairs support the pose; otherwise it claims nothing, and is the guess if there were none.
    #[must_use]
    pub fn is_supported(&self) -> bool {
        matches!(
            self,
            Self::SmallStep { .. } | Self::IterationLimit { .. } | Self::Unobservable { .. }
        )
    }
}

/// Names the motion `(t_x, t_y, ω)` that is not measured.
fn name_motion([x, y, turn]: [f64; 3]) -> String {
    if turn.abs() > math::norm2(x, y) {
        return "rotation".to_owned();
    }
    // A direction and its opposite are the same.
    let degrees = math::atan2(y, x).to_degrees().rem_euclid(180.0);
    format!("motion along {degrees:.0}° of the map")
}

impl core::fmt::Display for StopReason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::SmallStep { step, tolerance } => {
                write!(f, "step {step:.2e} below {tolerance:.2e}")
            }
            Self::IterationLimit { max_iterations } => {
                write!(f, "limit of {max_iterations} iterations")
            }
            Self::TooFewPairs { pairs, min_pairs } => {
                write!(f, "{pairs} pairs, at least {min_pairs} are needed")
            }
            Self::TooFewNormals {
                normals,
                pairs,
                min_normals,
            } => write!(
                f,
                "{normals} of {pairs} pairs have a normal, at least {min_normals} are needed"
            ),
            Self::TooFewInliers {
                inliers,
                min_pairs,
                width_m,
            } => write!(
                f,
                "{inliers} pairs within the kernel's {width_m} m, at least {min_pairs} are needed"
            ),
            Self::Unobservable { direction } => {
                write!(f, "no pair measures {}", name_motion(*direction))
            }
            Self::NotFinite => write!(f, "the next increment is not finite"),
        }
    }
}

/// Result of one iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IcpStep {
    /// The state after the iteration; unchanged if none was made.
    pub trace: IcpTrace,
    /// Set once the registration has ended.
    pub stop: Option<StopReason>,
}

/// The outcome of a registration without its history.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct IcpSummary {
    /// `target_from_source`.
    pub pose: SE2,
    /// Root mean square residual of the last pairs, m; infinite without pairs.
    pub rmse_m: f64,
    /// Number of the last pairs.
    pub inliers: usize,
    /// Increments made.
    pub iterations: usize,
    /// Why the registration ended.
    pub stop: StopReason,
}

/// The outcome of a registration with its history.
#[derive(Clone, Debug, PartialEq)]
pub struct IcpResult {
    /// `target_from_source`.
    pub pose: SE2,
    /// Root mean square residual of the last pairs, m; infinite without pairs.
    pub rmse_m: f64,
    /// Number of the last pairs.
    pub inliers: usize,
    /// The initial guess and the state after each increment: iterations = length − 1.
    pub trace: Vec<IcpTrace>,
    /// The last pairs.
    pub pairs: Vec<Pair>,
    /// Why the registration ended.
    pub stop: StopReason,
}

/// Registers `cloud` on `map` from the guess `init = target_from_source`.
///
/// ```
/// use ch16_slam2d::cloud::{PointCloud, VoxelMap};
/// use ch16_slam2d::icp::{IcpConfig, icp};
/// use pr_geom::{Point2, SE2};
///
/// // Two walls that meet in a corner.
/// let walls = |k: i32| {
///     let along = 0.1 * f64::from(k);
///     [Point2::new(along, 0.0), Point2::new(0.0, along)]
/// };
/// let target: PointCloud = (1..20).flat_map(walls).collect();
/// let map = VoxelMap::from_cloud(&target, 0.25, 8);
/// let source = target.transformed(&SE2::new(0.02, -0.03, 0.01));
/// let found = icp(&source, &map, SE2::identity(), &IcpConfig::default());
/// assert!(found.stop.converged());
/// assert!((found.pose * SE2::new(0.02, -0.03, 0.01)).step_size() < 1e-3);
/// ```
#[must_use]
pub fn icp<M: NearestMap>(cloud: &PointCloud, map: &M, init: SE2, config: &IcpConfig) -> IcpResult {
    let mut workspace = IcpWorkspace::new();
    let summary = Icp::new(cloud, map, init, config, &mut workspace).run();
    IcpResult {
        pose: summary.pose,
        rmse_m: summary.rmse_m,
        inliers: summary.inliers,
        pairs: workspace.pairs(map).collect(),
        trace: workspace.trace,
        stop: summary.stop,
    }
}

/// A custom increment: the motion that fits the pairs of one iteration best.
pub trait Increment: Send + Sync {
    /// The motion `increment` of `T ← increment ∘ T`; `pairs` has the moved points. One that is not finite ends the
    /// registration.
    fn increment(&self, pairs: &[Pair]) -> SE2;
}

/// A running registration.
pub struct Icp<'a, M> {
    cloud: &'a PointCloud,
    map: &'a M,
    config: IcpConfig,
    workspace: &'a mut IcpWorkspace,
    rejection: Option<&'a dyn PairRejection>,
    increment: Option<&'a dyn Increment>,
    current: IcpTrace,
    stop: Option<StopReason>,
}

impl<'a, M: NearestMap> Icp<'a, M> {
    /// Pairs the cloud at the guess `init = target_from_source`; no increment is made yet.
    #[must_use]
    pub fn new(
        cloud: &'a PointCloud,
        map: &'a M,
        init: SE2,
        config: &IcpConfig,
        workspace: &'a mut IcpWorkspace,
    ) -> Self {
        workspace.forget();
        workspace.trace.clear();
        let current = IcpTrace {
            pose: init,
            pairs: 0,
            rmse_m: f64::INFINITY,
            truncated_cost_m2: 0.0,
        };
        let mut registration = Self {
            cloud,
            map,
            config: *config,
            workspace,
            rejection: None,
            increment: None,
            current,
            stop: None,
        };
        registration.associate_at(init);
        registration
    }

    /// The same registration with only the pairs that `rule` accepts, from the initial guess on.
    #[must_use]
    pub fn with_rejection(mut self, rule: &'a dyn PairRejection) -> Self {
        self.rejection = Some(rule);
        self.workspace.trace.clear();
        self.associate_at(self.current.pose);
        self
    }

    /// The same registration with custom increments.
    #[must_use]
    pub fn with_increment(mut self, rule: &'a dyn Increment) -> Self {
        self.increment = Some(rule);
        self
    }

    /// Makes one increment, unless the registration has ended.
    pub fn step(&mut self) -> IcpStep {
        if self.stop.is_none() {
            self.stop = self.advance();
        }
        IcpStep {
            trace: self.current,
            stop: self.stop,
        }
    }

    /// Steps to the end.
    pub fn run(&mut self) -> IcpSummary {
        loop {
            if let Some(stop) = self.step().stop {
                return IcpSummary {
                    pose: self.current.pose,
                    rmse_m: self.current.rmse_m,
                    inliers: self.current.pairs,
                    iterations: self.workspace.trace.len() - 1,
                    stop,
                };
            }
        }
    }

    /// The pairs at the current pose.
    pub fn pairs(&self) -> impl Iterator<Item = Pair> + '_ {
        self.workspace.pairs(self.map)
    }

    fn advance(&mut self) -> Option<StopReason> {
        let IcpConfig {
            max_iterations,
            min_pairs,
            tolerance,
            ..
        } = self.config;
        if self.workspace.trace.len() > max_iterations {
            return Some(StopReason::IterationLimit { max_iterations });
        }
        let min_pairs = min_pairs.max(1);
        let too_few = |pairs| StopReason::TooFewPairs { pairs, min_pairs };
        let pairs = self.workspace.pair_count();
        if pairs < min_pairs {
            return Some(too_few(pairs));
        }
        let solved = match self.increment {
            Some(rule) => Solved::Custom(rule.increment(&self.pairs().collect::<Vec<_>>())),
            None => self.workspace.increment(&self.config),
        };
        let increment = solved.pose();
        let next = increment * self.current.pose;
        if !next.to_array().iter().all(|number| number.is_finite()) {
            return Some(StopReason::NotFinite);
        }
        self.associate_at(next);
        let step = increment.step_size();
        if step < tolerance {
            let pairs = self.workspace.pair_count();
            let width_m = self.config.huber_width_m;
            let is_weighted = width_m.is_finite() && self.increment.is_none();
            let inliers = match is_weighted {
                true => self.workspace.full_weights(&self.config),
                false => pairs,
            };
            let min_normals = self.config.min_normals();
            let normals = solved.normals().filter(|normals| *normals < min_normals);
            return Some(if pairs < min_pairs {
                too_few(pairs)
            } else if let Some(normals) = normals {
                StopReason::TooFewNormals {
                    normals,
                    pairs,
                    min_normals,
                }
            } else if inliers < min_pairs {
                StopReason::TooFewInliers {
                    inliers,
                    min_pairs,
                    width_m,
                }
            } else if let Some(direction) = solved.unobservable() {
                StopReason::Unobservable { direction }
            } else {
                StopReason::SmallStep { step, tolerance }
            });
        }
        (self.workspace.trace.len() > max_iterations)
            .then_some(StopReason::IterationLimit { max_iterations })
    }

    fn associate_at(&mut self, pose: SE2) {
        let workspace = &mut *self.workspace;
        workspace.associate(self.cloud, self.map, &pose, &self.config);
        if let Some(rule) = self.rejection {
            workspace.reject(rule);
        }
        self.current = IcpTrace {
            pose,
            pairs: workspace.pair_count(),
            rmse_m: workspace.rmse_m(),
            truncated_cost_m2: workspace.truncated_cost_m2,
        };
        workspace.trace.push(self.current);
    }
}
