//! A reader's function in place of a part of the estimator.
//!
//! The function is in another language and runs in a worker, which holds the same core. A widget sends an [`Order`] as
//! text; the worker executes it ([`Executor`]) and returns what the function answered; the widget computes the same with
//! these [`Answers`]. Its picture therefore has everything that it has of ours.

mod execute;
mod order;

use std::ops::Deref;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use ch16_slam2d::icp::{Accepted, IcpVariant, Increment, Pair, PairRejection};
use ch16_slam2d::loops::{InnovationGate, LoopConfig};
use nalgebra::Vector3;
use pr_geom::{SE2, math};

pub use execute::{Executor, Job};
pub use order::{BasinTask, LapTask, Order, Task};

/// The kind of a delivery that names the function which drives from now on; without text ours does.
pub const SEAT: &str = "your-code";
/// The kind of a delivery with the answers to the order that is its text.
pub const ANSWERS: &str = "your-answers";

/// A function of the page's exercises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// The increment of point to point.
    SvdAlign,
    /// The increment of point to plane.
    PointToPlaneStep,
    /// The rejection of pairs.
    KeepPairs,
    /// The test of a loop's innovation.
    Gate,
}

impl Function {
    const ALL: [Self; 4] = [
        Self::SvdAlign,
        Self::PointToPlaneStep,
        Self::KeepPairs,
        Self::Gate,
    ];

    /// The function of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|function| function.name() == name)
    }

    /// Its name in the reader's code.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::SvdAlign => "svd_align",
            Self::PointToPlaneStep => "point_to_plane_step",
            Self::KeepPairs => "keep_pairs",
            Self::Gate => "gate",
        }
    }

    /// The error that it reduces, if it is the increment of a registration.
    #[must_use]
    pub fn variant(self) -> Option<IcpVariant> {
        match self {
            Self::SvdAlign => Some(IcpVariant::PointToPoint),
            Self::PointToPlaneStep => Some(IcpVariant::PointToPlane),
            Self::KeepPairs | Self::Gate => None,
        }
    }

    /// Whether it is a part of a registration.
    #[must_use]
    pub fn registers(self) -> bool {
        self != Self::Gate
    }

    /// Whether it can be a part of a registration of that variant.
    #[must_use]
    pub fn fits(self, variant: IcpVariant) -> bool {
        self.registers() && self.variant().is_none_or(|own| own == variant)
    }
}

/// A custom rejection of pairs.
pub trait KeepPairs: Send + Sync {
    /// The indices of the pairs to drop, which ascend, from the length of each pair and the share to drop.
    fn dropped(&self, lengths_m: &[f64], trim: f64) -> Vec<usize>;
}

/// The same as a rule of ICP, which holds the share.
struct Rejection<P> {
    function: P,
    trim: f64,
}

impl<P: Deref<Target: KeepPairs> + Send + Sync> PairRejection for Rejection<P> {
    fn accepted(&self, squared_m2: &mut [f64]) -> Accepted {
        let lengths_m = squared_m2.iter().map(|&squared_m2| math::sqrt(squared_m2));
        let lengths_m: Vec<f64> = lengths_m.collect();
        Accepted::AllBut(self.function.dropped(&lengths_m, self.trim))
    }
}

/// What can stand in each seam; a [`Function`] is called in one of them.
pub trait Callable: Increment + KeepPairs + InnovationGate {}

impl<F: Increment + KeepPairs + InnovationGate> Callable for F {}

/// Answers of a function, in the order of its calls: three numbers for an increment, one for a gate, and for a rejection
/// the number of dropped pairs and their indices.
#[derive(Debug, Default)]
pub struct Answers {
    numbers: Vec<f64>,
    next: AtomicUsize,
}

impl Answers {
    /// Answers to be replayed. After the last one come NaN.
    #[must_use]
    pub fn new(numbers: &[f64]) -> Self {
        Self {
            numbers: numbers.to_vec(),
            next: AtomicUsize::new(0),
        }
    }

    /// The indices of the dropped pairs at each association, if the function keeps pairs.
    #[must_use]
    pub fn each_dropped(numbers: &[f64]) -> Vec<Vec<usize>> {
        let answers = Self::new(numbers);
        let is_left = || answers.next.load(Ordering::Relaxed) < numbers.len();
        let next = || is_left().then(|| answers.dropped(&[], 0.0));
        core::iter::from_fn(next).collect()
    }

    fn next(&self) -> f64 {
        let index = self.next.fetch_add(1, Ordering::Relaxed);
        self.numbers.get(index).copied().unwrap_or(f64::NAN)
    }
}

impl Increment for Answers {
    fn increment(&self, _: &[Pair]) -> SE2 {
        let [x, y, theta] = [(); 3].map(|()| self.next());
        SE2::new(x, y, theta)
    }
}

impl KeepPairs for Answers {
    fn dropped(&self, _: &[f64], _: f64) -> Vec<usize> {
        let count = (self.next() as usize).min(self.numbers.len());
        (0..count).map(|_| self.next() as usize).collect()
    }
}

impl InnovationGate for Answers {
    fn chi2(&self, _: &Vector3<f64>, _: usize, _: &LoopConfig) -> f64 {
        self.next()
    }
}

/// A function whose answers are recorded.
struct Recorder {
    function: Arc<dyn Callable>,
    numbers: Mutex<Vec<f64>>,
}

impl Recorder {
    fn record(&self, numbers: &[f64]) {
        let kept = self.numbers.lock();
        kept.unwrap_or_else(PoisonError::into_inner)
            .extend_from_slice(numbers);
    }

    /// The answers so far, which are then forgotten.
    fn take(&self) -> Vec<f64> {
        let kept = self.numbers.lock();
        core::mem::take(&mut *kept.unwrap_or_else(PoisonError::into_inner))
    }
}

impl Increment for Recorder {
    fn increment(&self, pairs: &[Pair]) -> SE2 {
        let found = self.function.increment(pairs);
        self.record(&found.to_array());
        found
    }
}

impl KeepPairs for Recorder {
    fn dropped(&self, lengths_m: &[f64], trim: f64) -> Vec<usize> {
        let found = self.function.dropped(lengths_m, trim);
        let mut numbers = vec![found.len() as f64];
        numbers.extend(found.iter().map(|&index| index as f64));
        self.record(&numbers);
        found
    }
}

impl InnovationGate for Recorder {
    fn chi2(&self, innovation: &Vector3<f64>, gap: usize, config: &LoopConfig) -> f64 {
        let found = self.function.chi2(innovation, gap, config);
        self.record(&[found]);
        found
    }
}
