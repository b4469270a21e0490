//! `slam2d-dev logs FOLDER --disturbed --leave-one-out NAME=V,V,…`: a parameter chosen on all logs but one, and reported
//! on that one.

use std::cmp::Ordering;

use robot_io::settings::Setting;

use super::disturbed::{DisturbedResult, Score};

/// A parameter and its values to choose from.
#[derive(Clone, Debug)]
pub struct Candidates {
    setting: &'static Setting,
    values: Vec<f64>,
}

/// Parses `NAME=V,V,…`.
///
/// # Errors
/// If there is no such parameter, fewer than two values, or one out of range.
pub fn candidates(text: &str) -> Result<Candidates, String> {
    let (name, values) = text.split_once('=').ok_or("expected NAME=VALUE,VALUE")?;
    let setting = Setting::named(name).map_err(|problem| problem.to_string())?;
    let number = |value: &str| {
        let value = value
            .parse()
            .map_err(|_| format!("{value} is not a number"))?;
        setting
            .check(value)
            .map_err(|problem| problem.to_string())?;
        Ok(value)
    };
    let values: Vec<f64> = values
        .split(',')
        .map(number)
        .collect::<Result<_, String>>()?;
    if values.len() < 2 {
        return Err(format!(
            "expected two or more values of {name}, separated by commas"
        ));
    }
    Ok(Candidates { setting, values })
}

impl Candidates {
    /// The parameter with each of its values.
    pub(super) fn each(&self) -> impl Iterator<Item = (&'static Setting, f64)> {
        self.values.iter().map(|value| (self.setting, *value))
    }

    /// The results of each log by the value chosen on the others, and a row with these values; `outcomes` has the
    /// results of all logs for each value.
    pub(super) fn chosen(
        &self,
        outcomes: &[Vec<Vec<DisturbedResult>>],
    ) -> (Vec<Vec<DisturbedResult>>, String) {
        let scores: Vec<Vec<Score>> = outcomes
            .iter()
            .map(|logs| logs.iter().map(|log| Score::of(log)).collect())
            .collect();
        let logs = outcomes.first().map_or(0, Vec::len);
        let picks: Vec<usize> = (0..logs).map(|left_out| best(&scores, left_out)).collect();
        let results = picks.iter().enumerate();
        let results = results.map(|(log, value)| outcomes[*value][log].clone());
        let values = picks.iter().map(|value| self.values[*value].to_string());
        let cells = values.collect::<Vec<_>>().join(" | ");
        let row = format!(
            "| {}, chosen on the other logs | {cells} |",
            self.setting.name
        );
        (results.collect(), row)
    }
}

/// The value with the best sum of scores over all logs but one; of equal ones the first.
fn best(scores: &[Vec<Score>], left_out: usize) -> usize {
    let sum = |value: usize| {
        let others = scores[value].iter().enumerate();
        let others = others.filter(|(log, _)| *log != left_out);
        others.fold(Score::default(), |sum, (_, score)| sum.plus(*score))
    };
    (1..scores.len()).fold(0, |best, value| match sum(value).compare(&sum(best)) {
        Ordering::Greater => value,
        _ => best,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_of_a_log_is_the_best_one_on_the_others() {
        let score = |held, ln_error| Score { held, ln_error };
        // The second value is far better on the last log only, and a little worse on the others.
        let scores = [
            vec![score(13, -2.0), score(13, -2.0), score(3, 0.0)],
            vec![score(13, -1.9), score(13, -1.9), score(13, -3.0)],
        ];
        let picks: Vec<usize> = (0..3).map(|log| best(&scores, log)).collect();
        assert_eq!(picks, [1, 1, 0]);
    }

    #[test]
    fn candidates_that_cannot_be_tried_are_rejected_in_a_sentence() {
        assert_eq!(
            candidates("keyframe_distance_m=0.5,1").map(|it| it.values),
            Ok(vec![0.5, 1.0])
        );
        for (text, word) in [
            ("keyframe_distance_m", "expected NAME"),
            ("keyframe_distance_m=1", "two or more values"),
            ("keyframe_distance_m=1,x", "x is not a number"),
            ("keyframe_distance_m=1,-1", "must be positive"),
            ("nonsense=1,2", "has no parameter nonsense"),
        ] {
            let problem = candidates(text).unwrap_err();
            assert!(problem.contains(word), "{text}: {problem}");
        }
    }
}
