//! The exercises of the chapter, computed without a page.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};
use widget_kit::model::{Model, Outcome};
use widgets::registry::{MODELS, SPECS};

use crate::answers::Answer;

/// Number of seeds that are tried until one of the choices is right.
const MAX_TRIES: u32 = 100;

/// The exercises in the order of their ids; the build writes the file from the pages.
static EXERCISES: LazyLock<Vec<Exercise>> = LazyLock::new(|| {
    serde_json::from_str(include_str!("exercises.json")).expect("a test reads the file")
});

/// One question of the page.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exercise {
    /// Its id: `16.5a`.
    pub exercise: String,
    widget: String,
    state: String,
    /// The fact in question; `None` if it is the verdict.
    fact: Option<String>,
    /// Largest error of a typed number.
    #[serde(default)]
    tolerance: f64,
    #[serde(default)]
    unit: String,
    /// "no" if everyone has the same task, because the answer hardly depends on a seed; `noise=3,4` if a personal task has
    /// one of these values.
    varies: Option<String>,
    choices: Vec<Choice>,
}

/// One of the answers offered.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Choice {
    choice: String,
    /// Smallest value for which it is right.
    from: Option<f64>,
    /// The values for which it is right are below.
    to: Option<f64>,
}

/// What the widget shows to one student.
#[derive(Clone, Debug)]
pub struct StudentTask {
    /// The state of the widget, with the student's seed.
    pub state: String,
    outcome: Outcome,
}

/// The assessment of one answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum AnswerMark {
    /// The right choice, or exactly the number.
    Right,
    /// A number that is close enough.
    WithinTolerance,
    /// Another choice, or another number.
    Wrong,
    /// No answer to this exercise; the note gives the reason.
    NotMarked,
}

/// A marked answer.
#[derive(Clone, Debug, Serialize)]
pub struct Marked {
    /// Id of the exercise.
    pub exercise: String,
    /// The mark.
    pub mark: AnswerMark,
    /// The student's choice or number.
    pub prediction: String,
    /// The right choice, or the number.
    pub right: Option<String>,
    /// The recomputed verdict or number.
    pub result: Option<String>,
    /// Unit of the number.
    pub unit: String,
    /// Number of answers to this exercise.
    pub attempts: u32,
    /// Moment of the answer, by the student's clock.
    pub time: String,
    /// A remark on the answer.
    pub note: Option<String>,
}

/// The ids in order.
pub fn ids() -> impl Iterator<Item = &'static str> {
    EXERCISES.iter().map(|exercise| exercise.exercise.as_str())
}

/// Number of exercises.
pub fn count() -> usize {
    EXERCISES.len()
}

/// Recomputes the exercise of an answer and marks it.
pub fn mark(answer: &Answer, student: &str) -> Marked {
    let mut marked = Marked {
        exercise: answer.exercise.clone(),
        mark: AnswerMark::NotMarked,
        prediction: answer.prediction.clone(),
        right: None,
        result: None,
        unit: String::new(),
        attempts: answer.attempts,
        time: answer.time.clone(),
        note: None,
    };
    let found = EXERCISES.iter().find(|e| e.exercise == answer.exercise);
    let Some(exercise) = found else {
        let known: Vec<&str> = EXERCISES.iter().map(|e| e.exercise.as_str()).collect();
        marked.note = Some(format!(
            "there is no such exercise; there are {}",
            known.join(", ")
        ));
        return marked;
    };
    let task = exercise.task(student);
    exercise.judge(answer, &task, &mut marked);
    marked
}

impl Exercise {
    /// The exercise as the page sets it for a student.
    pub fn task(&self, student: &str) -> StudentTask {
        if !student.is_empty() && self.is_personal() {
            let own = self.personal_state(student);
            let mut model = self.model(&own);
            for attempt in 0..MAX_TRIES {
                let seed = seed_of(student, &self.exercise, attempt);
                model
                    .set("seed", f64::from(seed))
                    .expect("a seed is any whole number of 32 bits");
                model.finish_work();
                let outcome = model.outcome();
                if self.has_answer(&outcome) {
                    let state = format!("{own}&seed={seed}");
                    return StudentTask { state, outcome };
                }
            }
        }
        let mut model = self.model(&self.state);
        model.finish_work();
        StudentTask {
            state: self.state.clone(),
            outcome: model.outcome(),
        }
    }

    /// Whether a name makes another task.
    fn is_personal(&self) -> bool {
        let widget = &SPECS[self.widget()];
        let takes_seed = widget.params.iter().any(|param| param.id == "seed");
        let has_seed = self.state.split('&').any(|pair| pair.starts_with("seed="));
        takes_seed && !has_seed && self.varies.as_deref() != Some("no")
    }

    /// The state of a student's task without its seed.
    ///
    /// The page derives the same (`web/ts/personal-seeds.ts`).
    fn personal_state(&self, student: &str) -> String {
        let Some((id, values)) = self
            .varies
            .as_deref()
            .and_then(|varies| varies.split_once('='))
        else {
            return self.state.clone();
        };
        let values: Vec<&str> = values.split(',').collect();
        let value = values[seed_of(student, &self.exercise, 0) as usize % values.len()];
        let pairs = self
            .state
            .split('&')
            .map(|pair| match pair.split_once('=') {
                Some((name, _)) if name == id => format!("{id}={value}"),
                _ => pair.to_owned(),
            });
        pairs.collect::<Vec<_>>().join("&")
    }

    fn widget(&self) -> usize {
        let at = SPECS.iter().position(|spec| spec.id == self.widget);
        at.expect("the build checks the widget")
    }

    /// The widget in a state of the question.
    fn model(&self, state: &str) -> Box<dyn Model> {
        let mut model = MODELS[self.widget()]();
        for pair in state.split('&') {
            let (id, text) = pair.split_once('=').expect("a name and a value");
            model.set_text(id, text).expect("a test sets each state");
        }
        model
    }

    fn fact(&self, outcome: &Outcome) -> Option<f64> {
        let fact = self.fact.as_deref()?;
        let found = outcome.facts.iter().find(|candidate| candidate.id == fact);
        found
            .map(|fact| fact.value)
            .filter(|value| value.is_finite())
    }

    /// The choice that is right for this outcome.
    fn right_choice(&self, outcome: &Outcome) -> Option<&Choice> {
        let value = self.fact(outcome);
        self.choices.iter().find(|choice| match value {
            Some(value) => {
                choice.from.is_none_or(|from| value >= from)
                    && choice.to.is_none_or(|to| value < to)
            }
            None => self.fact.is_none() && choice.choice == outcome.verdict,
        })
    }

    /// Whether one of the choices, or a number, is right.
    fn has_answer(&self, outcome: &Outcome) -> bool {
        if self.choices.is_empty() {
            self.fact(outcome).is_some()
        } else {
            self.right_choice(outcome).is_some()
        }
    }

    fn judge(&self, answer: &Answer, task: &StudentTask, marked: &mut Marked) {
        if answer.state != task.state {
            marked.note = Some(format!(
                "the state `{}` is not this student's task, which is `{}`",
                answer.state, task.state
            ));
            return;
        }
        let value = self.fact(&task.outcome);
        let result = value.map_or_else(|| task.outcome.verdict.clone(), |value| value.to_string());
        let is_same = value.map_or(answer.result == result, |value| {
            answer.result.parse() == Ok(value)
        });
        if !is_same {
            marked.note = Some(format!(
                "the file says that the page showed `{}`, but the result is `{result}`",
                answer.result
            ));
        }
        marked.result = Some(result);
        self.unit.trim().clone_into(&mut marked.unit);
        if self.choices.is_empty() {
            marked.right.clone_from(&marked.result);
            match (answer.prediction.parse::<f64>(), value) {
                (Ok(number), Some(value)) if number == value => marked.mark = AnswerMark::Right,
                (Ok(number), Some(value)) if (number - value).abs() <= self.tolerance => {
                    marked.mark = AnswerMark::WithinTolerance;
                }
                (Ok(_), _) => marked.mark = AnswerMark::Wrong,
                (Err(_), _) => {
                    marked.note = Some(format!("`{}` is not a number", answer.prediction));
                }
            }
            return;
        }
        let right = self.right_choice(&task.outcome);
        marked.right = right.map(|choice| choice.choice.clone());
        if marked.right.as_ref() == Some(&answer.prediction) {
            marked.mark = AnswerMark::Right;
        } else if self.choices.iter().any(|c| c.choice == answer.prediction) {
            marked.mark = AnswerMark::Wrong;
        } else {
            let choices: Vec<&str> = self.choices.iter().map(|c| c.choice.as_str()).collect();
            marked.note = Some(format!(
                "`{}` is none of the choices: {}",
                answer.prediction,
                choices.join(", ")
            ));
        }
    }
}

/// The seed of a student's exercise: FNV-1a over the text, then the finalizer of `MurmurHash3`.
///
/// The page derives the same (`web/ts/personal-seeds.ts`).
fn seed_of(student: &str, exercise: &str, attempt: u32) -> u32 {
    let text = format!("{student}\n{exercise}\n{attempt}");
    let mut hash = text.bytes().fold(0x811c_9dc5_u32, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    });
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Deserialize)]
    struct Seed {
        student: String,
        exercise: String,
        attempt: u32,
        seed: u32,
    }

    #[test]
    fn seeds_are_those_of_the_page() {
        let text = include_str!("../../../tests/reference/student-seeds.json");
        let seeds: Vec<Seed> = serde_json::from_str(text).unwrap();
        assert!(seeds.len() >= 5);
        for seed in seeds {
            let derived = seed_of(&seed.student, &seed.exercise, seed.attempt);
            assert_eq!(derived, seed.seed, "{} {}", seed.student, seed.exercise);
        }
    }

    #[test]
    fn every_exercise_has_an_answer_for_the_chapter_and_for_each_student() {
        for exercise in EXERCISES.iter() {
            for student in ["", "Ann", "Βασίλης", "3217"] {
                let task = exercise.task(student);
                assert!(
                    exercise.has_answer(&task.outcome),
                    "{} for {student:?}: {:?}",
                    exercise.exercise,
                    task.outcome
                );
            }
        }
    }

    /// The class of the tests: 80 made-up names.
    fn class() -> impl Iterator<Item = String> {
        (0..80).map(|number| format!("student-{number:02}"))
    }

    /// A personal task of which most of a class have the same answer would be copied.
    #[test]
    fn no_answer_to_a_personal_task_is_that_of_more_than_half_of_a_class() {
        for exercise in EXERCISES.iter().filter(|one| one.is_personal()) {
            let mut answers = std::collections::HashMap::new();
            for student in class() {
                let task = exercise.task(&student);
                assert_ne!(task.state, exercise.state, "{}", exercise.exercise);
                let right = match exercise.right_choice(&task.outcome) {
                    Some(choice) => choice.choice.clone(),
                    None => format!("{:?}", exercise.fact(&task.outcome)),
                };
                *answers.entry(right).or_insert(0) += 1;
            }
            let most = answers.values().max().copied().unwrap_or(0);
            assert!(most <= 40, "{}: {answers:?}", exercise.exercise);
        }
    }

    #[test]
    fn neighbours_have_other_laps() {
        let lap = EXERCISES.iter().find(|e| e.exercise == "16.5b").unwrap();
        let [ann, bob, chapter] = ["Ann", "Bob", ""].map(|student| lap.task(student).state);
        assert!(ann.starts_with("noise=3.25&t=92&seed="), "{ann}");
        assert_ne!(ann, bob);
        assert_eq!(chapter, "noise=4&t=92");
    }
}
