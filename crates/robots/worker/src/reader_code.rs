//! The core in the worker of a reader's function, which is JavaScript: orders in, answers out.

use std::cell::RefCell;
use std::sync::Arc;

use ch16_lab::reader_code::{Callable, Executor, Function, Job, KeepPairs};
use ch16_slam2d::icp::{Increment, Pair};
use ch16_slam2d::loops::{InnovationGate, LoopConfig};
use js_sys::{Array, ArrayBuffer, Float64Array, Function as JsFunction, Reflect};
use nalgebra::Vector3;
use pr_geom::SE2;
use wasm_bindgen::prelude::*;

thread_local! {
    /// The function of this worker, and the first error that it has thrown. The seams of the core are for all threads,
    /// and a JavaScript value is of one.
    static WRITTEN: RefCell<Option<Written>> = const { RefCell::new(None) };
}

struct Written {
    name: Function,
    function: JsFunction,
    thrown: Option<JsValue>,
}

/// The function of this worker in the seams of the core.
struct Called;

/// Calls the function; an error is kept, and there is no answer.
fn call<T>(arguments: &Array, read: impl FnOnce(&JsValue) -> Result<T, String>) -> Option<T> {
    WRITTEN.with_borrow_mut(|written| {
        let written = written
            .as_mut()
            .filter(|written| written.thrown.is_none())?;
        let called = written.function.apply(&JsValue::UNDEFINED, arguments);
        let name = written.name.name();
        let answer = called.and_then(|value| {
            read(&value).map_err(|problem| js_sys::Error::new(&format!("{name} {problem}")).into())
        });
        answer.map_err(|thrown| written.thrown = Some(thrown)).ok()
    })
}

fn flat(points: impl Iterator<Item = [f64; 2]>) -> JsValue {
    let numbers: Vec<f64> = points.flatten().collect();
    Float64Array::from(numbers.as_slice()).into()
}

/// The numbers of an array or a typed array; an item that is none is NaN.
fn numbers(value: &JsValue) -> Option<Vec<f64>> {
    let number = |item: JsValue| item.as_f64().unwrap_or(f64::NAN);
    let is_list = Array::is_array(value) || ArrayBuffer::is_view(value);
    is_list.then(|| Array::from(value).iter().map(number).collect())
}

/// A motion `[x, y, θ]`.
fn motion(value: &JsValue) -> Result<[f64; 3], String> {
    let motion: Option<[f64; 3]> = numbers(value).and_then(|numbers| numbers.try_into().ok());
    let motion = motion.ok_or("has to return three numbers, [x, y, θ]")?;
    if motion.iter().all(|number| number.is_finite()) {
        return Ok(motion);
    }
    let [x, y, theta] = motion;
    Err(format!(
        "returned [{x}, {y}, {theta}]: each has to be a finite number"
    ))
}

/// The pairs, of `count`, that are not among the kept ones.
fn dropped(value: &JsValue, count: usize) -> Result<Vec<usize>, String> {
    let kept = numbers(value).ok_or_else(|| {
        "has to return an array of the indices of the pairs that it keeps".to_owned()
    })?;
    let mut is_kept = vec![false; count];
    for number in kept {
        let index = Some(number as usize).filter(|index| *index as f64 == number);
        let pair = index.and_then(|index| is_kept.get_mut(index));
        *pair
            .ok_or_else(|| format!("keeps pair {number} of {count}; they are numbered from 0"))? =
            true;
    }
    let pairs = is_kept.iter().enumerate();
    let dropped = pairs.filter(|(_, is_kept)| !**is_kept);
    Ok(dropped.map(|(index, _)| index).collect())
}

/// The χ² of `{chi2, accepted}`, whose verdict has to be that of χ² ≤ limit; only an innovation that is no number has none.
fn chi2(value: &JsValue, innovation: &Vector3<f64>, limit: f64) -> Result<f64, String> {
    let field = |name: &str| Reflect::get(value, &JsValue::from_str(name)).ok();
    let chi2 = field("chi2").and_then(|found| found.as_f64());
    let accepted = field("accepted").and_then(|found| found.as_bool());
    let (Some(chi2), Some(accepted)) = (chi2, accepted) else {
        return Err("has to return an object {chi2, accepted}".to_owned());
    };
    if chi2.is_nan() && innovation.iter().all(|part| part.is_finite()) {
        return Err("returned χ² NaN for an innovation of three numbers".to_owned());
    }
    if accepted == (chi2 <= limit) {
        return Ok(chi2);
    }
    let relation = if accepted { "accepts" } else { "rejects" };
    Err(format!(
        "{relation} a loop of χ² {chi2:.3} at the limit {limit:.3}: accepted has to be χ² ≤ limit"
    ))
}

impl Increment for Called {
    fn increment(&self, pairs: &[Pair]) -> SE2 {
        let none = [f64::NAN; 2];
        let arguments = Array::of3(
            &flat(pairs.iter().map(|pair| [pair.source.x, pair.source.y])),
            &flat(pairs.iter().map(|pair| [pair.target.x, pair.target.y])),
            &flat(
                pairs
                    .iter()
                    .map(|pair| pair.normal.map_or(none, |normal| [normal.x, normal.y])),
            ),
        );
        let [x, y, theta] = call(&arguments, motion).unwrap_or([f64::NAN; 3]);
        SE2::new(x, y, theta)
    }
}

impl KeepPairs for Called {
    fn dropped(&self, lengths_m: &[f64], trim: f64) -> Vec<usize> {
        let arguments = Array::of2(&Float64Array::from(lengths_m).into(), &trim.into());
        call(&arguments, |value| dropped(value, lengths_m.len()))
            // Without a pair the registration ends.
            .unwrap_or_else(|| (0..lengths_m.len()).collect())
    }
}

impl InnovationGate for Called {
    fn chi2(&self, innovation: &Vector3<f64>, gap: usize, config: &LoopConfig) -> f64 {
        let arguments = Array::of4(
            &Float64Array::from(innovation.as_slice()),
            &JsValue::from_f64(gap as f64),
            &Array::of2(&config.drift_sigma_m.into(), &config.drift_sigma_rad.into()),
            &config.gate_chi2.into(),
        );
        call(&arguments, |value| {
            chi2(value, innovation, config.gate_chi2)
        })
        .unwrap_or(f64::NAN)
    }
}

/// A reader's function and what executes orders with it; one in each worker.
#[wasm_bindgen]
pub struct ReaderCode {
    executor: Executor,
    function: Arc<dyn Callable>,
    job: Option<Job>,
}

#[wasm_bindgen]
impl ReaderCode {
    /// Puts a function into the seams of the core.
    ///
    /// # Errors
    /// If there is no seam for a function of that name.
    #[wasm_bindgen(constructor)]
    pub fn new(name: &str, function: JsFunction) -> Result<Self, JsError> {
        let name = Function::named(name)
            .ok_or_else(|| JsError::new(&format!("no part of the estimator is called {name}")))?;
        WRITTEN.set(Some(Written {
            name,
            function,
            thrown: None,
        }));
        Ok(Self {
            executor: Executor::default(),
            function: Arc::new(Called),
            job: None,
        })
    }

    /// Starts an order of a widget.
    ///
    /// # Errors
    /// If it is none.
    pub fn begin(&mut self, order: &str) -> Result<(), JsError> {
        let job = self.executor.begin(order, &self.function);
        self.job = Some(job.map_err(|problem| JsError::new(&problem))?);
        Ok(())
    }

    /// Does a piece of the order; the answers once it is finished.
    ///
    /// # Errors
    /// What the function has thrown.
    pub fn step(&mut self) -> Result<Option<Vec<f64>>, JsValue> {
        let done = self.job.as_mut().and_then(Job::step);
        let thrown = WRITTEN.with_borrow_mut(|written| written.as_mut()?.thrown.take());
        thrown.map_or(Ok(done), Err)
    }
}
