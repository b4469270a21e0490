//! The exercises of the chapter, computed without a page.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};
use widget_kit::model::{Model, Outcome};
use widgets::registry::{MODELS, SPECS};

use crate::answers::Answer;

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
    /// "no" if everyone has the same task, because the answer hardly depends on a seed; otherwise the personal tasks,
    /// `noise seed: 3.25 12, 3.5 7`: names of parameters, and the values of each task. No answer has more than a third of the tasks.
    varies: String,
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
        let state = self.state_of(student);
        let mut model = self.model(&state);
        model.finish_work();
        StudentTask {
            outcome: model.outcome(),
            state,
        }
    }

    /// The states of the personal tasks; none if everyone has the same task.
    fn personal_states(&self) -> Vec<String> {
        let Some((names, tasks)) = self.varies.split_once(':') else {
            return Vec::new();
        };
        let state_of = |task: &str| {
            let mut pairs: Vec<(&str, &str)> = (self.state.split('&'))
                .filter_map(|pair| pair.split_once('='))
                .collect();
            for (id, value) in names.split_whitespace().zip(task.split_whitespace()) {
                match pairs.iter_mut().find(|(known, _)| *known == id) {
                    Some((_, old)) => *old = value,
                    None => pairs.push((id, value)),
                }
            }
            let pairs = pairs.into_iter().map(|(id, value)| format!("{id}={value}"));
            pairs.collect::<Vec<_>>().join("&")
        };
        tasks.split(',').map(state_of).collect()
    }

    /// The state of a student's task; the page derives the same (`web/ts/personal-seeds.ts`).
    fn state_of(&self, student: &str) -> String {
        let mut states = self.personal_states();
        if student.is_empty() || states.is_empty() {
            return self.state.clone();
        }
        let number = seed_of(student, &self.exercise, 0) as usize % states.len();
        states.swap_remove(number)
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

    /// The choice or number that is right in a state.
    fn answer_in(exercise: &Exercise, state: &str) -> Option<String> {
        let mut model = exercise.model(state);
        model.finish_work();
        let outcome = model.outcome();
        match exercise.right_choice(&outcome) {
            Some(choice) => Some(choice.choice.clone()),
            None => exercise.fact(&outcome).map(|value| value.to_string()),
        }
    }

    #[test]
    fn every_exercise_has_an_answer_in_the_chapter() {
        for exercise in EXERCISES.iter() {
            let answer = answer_in(exercise, &exercise.state);
            assert!(answer.is_some(), "{}", exercise.exercise);
        }
    }

    /// Names and tokens as a course may have them, 80 each.
    fn classes() -> Vec<Vec<String>> {
        const GIVEN: [&str; 8] = ["Ann", "Bob", "Βασίλης", "李", "Olga", "محمد", "José", "Zoë"];
        let tokens = (0..80).map(|k| format!("student-{k:02}"));
        let numbers = (0..80).map(|k| (3_210_000 + 37 * k).to_string());
        let short = (1..=80).map(|k| format!("S{k}"));
        let family = [
            "Lee",
            "Müller",
            "Παππάς",
            "Kim",
            "Ito",
            "Roy",
            "Cruz",
            "Nagy",
            "Diaz",
            "Wu",
        ];
        let names = GIVEN
            .iter()
            .flat_map(|one| family.map(|other| format!("{one} {other}")));
        let mails = (0..80).map(|k| format!("{}{k}@uni.example", GIVEN[k % 8].to_lowercase()));
        vec![
            tokens.collect(),
            numbers.collect(),
            short.collect(),
            names.collect(),
            mails.collect(),
        ]
    }

    /// The chance that more than 40 of 80 students get one of the tasks that make up `share` of all.
    fn chance_of_most(share: f64) -> f64 {
        let mut exactly = (1.0 - share).powi(80);
        let mut more = 0.0;
        for students in 1..=80 {
            exactly *= f64::from(81 - students) / f64::from(students) * share / (1.0 - share);
            if students > 40 {
                more += exactly;
            }
        }
        more
    }

    /// A personal task of which most of a class have the same answer would be copied. No answer has more than a third of
    /// the tasks, and a hash deals them; the guide states how many classes of 80 share an answer even so.
    #[test]
    fn no_answer_to_a_personal_task_is_that_of_more_than_half_of_a_class() {
        let mut personal = 0;
        let mut shared: f64 = 0.0;
        for exercise in EXERCISES.iter() {
            let states = exercise.personal_states();
            if states.is_empty() {
                assert_eq!(exercise.varies, "no", "{}", exercise.exercise);
                continue;
            }
            personal += 1;
            let answers: std::collections::HashMap<&String, String> = states
                .iter()
                .map(|state| {
                    (
                        state,
                        answer_in(exercise, state).expect("one of the choices is right"),
                    )
                })
                .collect();
            assert_eq!(
                answers.len(),
                states.len(),
                "{}: two tasks are the same",
                exercise.exercise
            );
            let mut chance = 0.0;
            for choice in &exercise.choices {
                let right = answers.values().filter(|answer| **answer == choice.choice);
                let tasks = right.count();
                assert!(
                    3 * tasks <= states.len(),
                    "{} {}: {tasks} of {}",
                    exercise.exercise,
                    choice.choice,
                    states.len()
                );
                chance += chance_of_most(tasks as f64 / states.len() as f64);
            }
            shared = shared.max(chance);
            for class in classes() {
                let mut counts = std::collections::HashMap::new();
                for student in &class {
                    *counts
                        .entry(&answers[&exercise.state_of(student)])
                        .or_insert(0) += 1;
                }
                let most = counts.values().max().copied().unwrap_or(0);
                assert!(
                    class.len() == 80 && most <= 40,
                    "{}: {counts:?}",
                    exercise.exercise
                );
            }
        }
        assert_eq!(personal, 3, "16.5a, b and c");
        let classes = 100.0 * (0.01 / shared).round();
        let guide = include_str!("../../guide/marking.md").replace('\n', " ");
        let said = format!("more than half the students share an answer is about 1 in {classes}");
        assert!(guide.contains(&said), "{said}");
    }

    #[test]
    fn neighbours_have_other_laps() {
        let lap = EXERCISES.iter().find(|e| e.exercise == "16.5b").unwrap();
        let [ann, bob, chapter] = ["Ann", "Bob", ""].map(|student| lap.task(student).state);
        assert_eq!(ann, "noise=3.25&t=92&seed=256");
        assert_ne!(ann, bob);
        assert_eq!(chapter, "noise=4&t=92");
    }
}
