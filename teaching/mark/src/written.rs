//! Marks functions that students wrote in the page, by the tests of the page.
//!
//! They run in QuickJS, which has neither files nor network: an engine in the command needs no Node, and what it does not
//! have cannot be reached by what a stranger wrote. The code and the tests have a realm each, and pass text to each other;
//! each call has a number of steps, the same on every machine, and memory is limited. What a right function may use of the
//! page's worker, as its console, is here too, and silent.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, LazyLock, mpsc};
use std::thread;
use std::time::Duration;

use rquickjs::{CatchResultExt as _, Context, Ctx, Exception, Function, Object, Runtime, Value};

use crate::answers::{SOLUTION_SHOWN, Written};
use crate::exercise::{AnswerMark, Marked};

/// The tests; the build writes the file from the page's.
const TESTS: &str = include_str!("written.js");
/// Most steps of a call: turns of a loop, and calls. The page gives a second to an engine that compiles.
const MOST_STEPS: u64 = 200_000_000;
/// Steps between two looks at their number; fixed in `QuickJS`.
const STEPS_OF_A_LOOK: u64 = 10_000;
/// Longest time of a function, whose built-in calls count no steps.
const PATIENCE: Duration = Duration::from_secs(300);
/// What the code finds of the page's worker.
const SURROUNDINGS: &str = "globalThis.console = new Proxy({}, {get: () => () => {}});
for (const name of ['setTimeout', 'setInterval', 'clearTimeout', 'clearInterval']) globalThis[name] = () => 0;
globalThis.structuredClone = (value) => {
  if (ArrayBuffer.isView(value)) return value.slice();
  if (Array.isArray(value)) return value.map((one) => structuredClone(one));
  if (typeof value !== 'object' || value === null) return value;
  return Object.fromEntries(Object.entries(value).map(([key, one]) => [key, structuredClone(one)]));
};
undefined";
/// Most memory of the engine.
const MEMORY_BYTES: usize = 64 << 20;
/// Most stack of the engine.
const STACK_BYTES: usize = 256 << 10;
/// Longest array that a function may return.
const MOST_ITEMS: usize = 1000;

/// Ids of the functions in the gradebook: `code.svd_align`.
static IDS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let names = Engine::new().and_then(|engine| engine.tests(|tests| tests.call("names", ())));
    let names: Vec<String> = names.expect("a test runs the tests");
    names.iter().map(|name| id_of(name)).collect()
});

/// Ids of the functions in the gradebook.
pub fn ids() -> impl Iterator<Item = &'static str> {
    IDS.iter().map(String::as_str)
}

fn id_of(name: &str) -> String {
    format!("code.{name}")
}

/// Marks a function.
pub fn mark(written: &Written) -> Marked {
    let mut marked = Marked {
        exercise: id_of(&written.function),
        mark: AnswerMark::NotMarked,
        prediction: format!("{} lines", written.code.lines().count()),
        right: None,
        result: None,
        unit: String::new(),
        attempts: written.attempts,
        time: written.time.clone(),
        note: None,
    };
    if !ids().any(|id| id == marked.exercise) {
        let known: Vec<&str> = ids().collect();
        marked.note = Some(format!(
            "there is no such function; there are {}",
            known.join(", ")
        ));
        return marked;
    }
    match run(written.function.clone(), written.code.clone()) {
        Ok(Run {
            passed,
            tests,
            fault,
        }) => {
            marked.mark = if passed == tests {
                AnswerMark::Right
            } else {
                AnswerMark::Wrong
            };
            marked.right = Some(format!("{tests} tests"));
            marked.result = Some(format!("{passed} tests"));
            marked.note = fault;
        }
        Err(problem) => {
            marked.mark = AnswerMark::Wrong;
            marked.note = Some(problem);
        }
    }
    if written.help >= Some(SOLUTION_SHOWN) {
        let shown = "the page had shown its solution";
        marked.note = Some(
            marked
                .note
                .map_or_else(|| shown.to_owned(), |fault| format!("{shown}; {fault}")),
        );
    }
    marked
}

/// Runs the tests of a function in a thread, which is left alone if it does not end.
fn run(function: String, code: String) -> Result<Run, String> {
    let (answer, answered) = mpsc::channel();
    thread::spawn(move || {
        let run = Engine::new().and_then(|engine| engine.run(&function, &code));
        // Whoever waited too long does not listen.
        let _ = answer.send(run);
    });
    let run = answered.recv_timeout(PATIENCE);
    run.unwrap_or_else(|_| Err(format!("there was no answer for {} s", PATIENCE.as_secs())))
}

/// The results of the tests of one function.
struct Run {
    passed: usize,
    tests: usize,
    /// The sentence of the first failure.
    fault: Option<String>,
}

/// The engine for one function.
struct Engine {
    /// Looks at the number of steps since the last call began.
    looks: Arc<AtomicU64>,
    tests: Context,
    code: Context,
}

/// The tests in their realm.
struct Tests<'js> {
    ctx: Ctx<'js>,
    marking: Object<'js>,
}

impl<'js> Tests<'js> {
    fn call<A, R>(&self, name: &str, arguments: A) -> rquickjs::Result<R>
    where
        A: rquickjs::function::IntoArgs<'js>,
        R: rquickjs::FromJs<'js>,
    {
        self.marking.get::<_, Function<'js>>(name)?.call(arguments)
    }
}

impl Engine {
    fn new() -> Result<Self, String> {
        let start = || {
            let runtime = Runtime::new()?;
            runtime.set_memory_limit(MEMORY_BYTES);
            runtime.set_max_stack_size(STACK_BYTES);
            let looks = Arc::new(AtomicU64::new(0));
            let counted = Arc::clone(&looks);
            let is_over =
                move || counted.fetch_add(1, Ordering::Relaxed) >= MOST_STEPS / STEPS_OF_A_LOOK;
            runtime.set_interrupt_handler(Some(Box::new(is_over)));
            let [tests, code] = [Context::full(&runtime)?, Context::full(&runtime)?];
            code.with(|ctx| ctx.eval::<(), _>(SURROUNDINGS))?;
            Ok(Self { looks, tests, code })
        };
        start().map_err(|problem: rquickjs::Error| problem.to_string())
    }

    /// Gives what follows its steps.
    fn wind(&self) {
        self.looks.store(0, Ordering::Relaxed);
    }

    /// Whether they are used up.
    fn is_over(&self) -> bool {
        self.looks.load(Ordering::Relaxed) > MOST_STEPS / STEPS_OF_A_LOOK
    }

    /// Calls something of the tests.
    fn tests<R>(&self, call: impl FnOnce(&Tests<'_>) -> rquickjs::Result<R>) -> Result<R, String> {
        self.wind();
        self.tests.with(|ctx| {
            let called = || {
                if !ctx.globals().contains_key("marking")? {
                    ctx.eval::<(), _>(TESTS)?;
                }
                let marking = ctx.globals().get("marking")?;
                call(&Tests {
                    ctx: ctx.clone(),
                    marking,
                })
            };
            called().catch(&ctx).map_err(|problem| problem.to_string())
        })
    }

    /// Evaluates text in the realm of the code; the result is again text.
    fn evaluate(&self, text: &str) -> Result<String, String> {
        self.wind();
        self.code.with(|ctx| {
            let value = ctx
                .eval::<Value<'_>, _>(text)
                .and_then(|value| source(&value, 2));
            value.catch(&ctx).map_err(|problem| {
                if self.is_over() {
                    return format!(
                        "there was no answer after {} million steps; is there an infinite loop?",
                        MOST_STEPS / 1_000_000
                    );
                }
                let problem = problem.to_string();
                let first = problem.lines().next().unwrap_or_default();
                format!("the code ended with {first}")
            })
        })
    }

    fn run(&self, function: &str, code: &str) -> Result<Run, String> {
        self.evaluate(&format!("{code}\n;undefined"))?;
        if self.evaluate(&format!("typeof {function}"))? != "\"function\"" {
            return Err(format!("there is no function {function}"));
        }
        let tests: usize = self.tests(|tests| tests.call("count", (function,)))?;
        let mut run = Run {
            passed: 0,
            tests,
            fault: None,
        };
        for test in 0..tests {
            let call: String = self.tests(|tests| tests.call("call", (function, test)))?;
            let fault = match self.evaluate(&call) {
                Ok(result) => self.tests(|tests| {
                    let result: Value<'_> = tests.ctx.eval(format!("({result})"))?;
                    tests.call::<_, String>("fault", (function, test, result))
                })?,
                // The next call would take as long.
                Err(problem) if self.is_over() => return Err(problem),
                Err(problem) => problem,
            };
            if fault.is_empty() {
                run.passed += 1;
            } else {
                run.fault.get_or_insert(fault);
            }
        }
        Ok(run)
    }
}

/// A result as text that evaluates to the same in another realm, as far as a test reads it.
fn source(value: &Value<'_>, depth: usize) -> rquickjs::Result<String> {
    if let Some(number) = value.as_number() {
        return Ok(match number {
            _ if number == f64::INFINITY => "Infinity".to_owned(),
            _ if number == f64::NEG_INFINITY => "-Infinity".to_owned(),
            _ => format!("{number:?}"),
        });
    }
    if let Some(is_so) = value.as_bool() {
        return Ok(is_so.to_string());
    }
    if let Some(text) = value.as_string() {
        return Ok(serde_json::Value::from(text.to_string()?).to_string());
    }
    let Some(object) = value.as_object().filter(|_| depth > 0) else {
        return Ok(if value.is_null() { "null" } else { "undefined" }.to_owned());
    };
    if object.get::<_, Value<'_>>("then")?.is_function() {
        let ctx = value.ctx();
        return Err(Exception::throw_message(ctx, "a promise: leave out async"));
    }
    let length: Value<'_> = object.get("length")?;
    if let Some(length) = length.as_number().filter(|_| !value.is_function()) {
        let items = (0..(length as usize).min(MOST_ITEMS) as u32)
            .map(|index| source(&object.get(index)?, depth - 1))
            .collect::<rquickjs::Result<Vec<_>>>()?;
        return Ok(format!("[{}]", items.join(", ")));
    }
    let field = |name: &str| source(&object.get(name)?, 0);
    let (chi2, accepted) = (field("chi2")?, field("accepted")?);
    Ok(format!("{{chi2: {chi2}, accepted: {accepted}}}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(function: &str, code: &str) -> Marked {
        mark(&Written {
            function: function.to_owned(),
            code: code.to_owned(),
            attempts: 1,
            time: String::new(),
            help: None,
        })
    }

    const GATE: &str = "function gate([x, y, t], gap, [a, b], limit) {
        const chi2 = (x * x + y * y) / (gap * a * a) + t * t / (gap * b * b);
        return {chi2, accepted: chi2 <= limit}; }";

    #[test]
    fn a_right_function_passes_and_a_wrong_one_is_told_its_fault() {
        let right = marked("gate", GATE);
        assert_eq!((right.mark, right.note), (AnswerMark::Right, None));
        assert_eq!(right.result.as_deref(), Some("7 tests"));
        let wrong = marked("gate", &GATE.replace("<= limit", "<= 7.815"));
        assert_eq!(wrong.mark, AnswerMark::Wrong);
        assert!(
            wrong
                .note
                .unwrap()
                .starts_with("Another limit: expected χ² 9.000"),
            "the constant is caught"
        );
        for function in ["svd_align", "point_to_plane_step", "keep_pairs", "gate"] {
            let stub = marked(
                function,
                &format!("function {function}() {{ return [0, 0, 0]; }}"),
            );
            assert_eq!(stub.mark, AnswerMark::Wrong, "{function}");
            assert!(stub.note.unwrap().contains("expected"), "{function}");
        }
    }

    #[derive(serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Judged {
        kind: String,
        function: String,
        code: String,
        passes: bool,
    }

    /// tests/browser/write.test.mjs judges the same functions by the page.
    #[test]
    fn functions_are_judged_as_in_the_page() {
        let text = include_str!("../../../tests/reference/written-functions.json");
        let corpus: Vec<Judged> = serde_json::from_str(text).unwrap();
        assert!(corpus.len() > 40);
        for one in corpus {
            let found = marked(&one.function, &one.code);
            let passes = found.mark == AnswerMark::Right;
            assert_eq!(passes, one.passes, "{}: {:?}", one.kind, found.note);
            assert_ne!(found.note.is_some(), passes, "{}", one.kind);
        }
    }

    #[test]
    fn the_note_names_what_ended_the_code() {
        for (code, note) in [
            (
                "for (;;) {}",
                "no answer after 200 million steps; is there an infinite loop?",
            ),
            ("function gate() { return y; }", "y is not defined"),
            ("const other = 1;", "there is no function gate"),
            ("function gate( {", "the code ended with"),
            ("async function gate() {}", "a promise: leave out async"),
            (
                "const all = []; function gate() { for (;;) all.push(new Array(1e6).fill(1)); }",
                "",
            ),
        ] {
            let told = marked("gate", code).note.unwrap();
            assert!(told.contains(note), "{code}: {told}");
        }
    }

    #[test]
    fn the_engine_has_neither_files_nor_network() {
        let names = [
            "require",
            "process",
            "fetch",
            "XMLHttpRequest",
            "Worker",
            "std",
            "os",
            "postMessage",
        ];
        for name in names {
            let found = marked(
                "gate",
                &format!("if (typeof {name} !== 'undefined') throw 1;\n{GATE}"),
            );
            assert_eq!(found.mark, AnswerMark::Right, "{name}");
        }
        let found = marked("gate", &format!("import('fs').then(() => {{}});\n{GATE}"));
        assert_eq!(found.mark, AnswerMark::Right, "an import finds nothing");
    }

    #[test]
    fn an_unknown_function_is_not_marked() {
        let found = marked("main", "function main() {}");
        assert_eq!(found.mark, AnswerMark::NotMarked);
        assert!(
            found
                .note
                .unwrap()
                .contains("code.svd_align, code.point_to_plane_step, code.keep_pairs, code.gate")
        );
    }
}
