//! Recordings that people have: each is mapped and compared with its truth, or rejected in a sentence.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::anyhow;
use robot_io::evaluate::{Alignment, truth_errors};
use robot_io::graph_file::GraphFile;
use robot_io::log::{LogOptions, LogReader as _};
use robot_io::log_format::LogFormat;
use robot_io::run::LogRun;
use robot_io::session::Session;
use robot_io::trajectory::Trajectory;

use command_line::in_file::InFile as _;
use command_line::log_file::open_robots;

/// File of a folder whose recordings are listed.
const README: &str = "README";
/// File that makes a folder one recording.
const METADATA: &str = "metadata.yaml";
/// A recording of another day, and that whose map it is continued on.
const OTHER_DAY: [&str; 2] = [
    "sessions_small/tuesday_elsewhere.mcap",
    "sessions_small/monday.mcap",
];
/// A recording of several robots.
const ROBOTS: &str = "two_robots/namespaced.mcap";

/// The recordings of the subfolders with a README, by name. True paths beside them are none.
fn recordings(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for folder in entries(folder)?
        .iter()
        .filter(|path| path.join(README).exists())
    {
        for path in entries(folder)? {
            let is_group = path.is_dir() && !path.join(METADATA).exists() && !is_split(&path);
            found.extend(if is_group {
                entries(&path)?
            } else {
                vec![path]
            });
        }
    }
    found.retain(|path| !path.ends_with(README) && !is_truth(path));
    Ok(found)
}

/// What is in a folder, by name.
fn entries(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).in_file(folder)?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

/// Whether a folder has the parts of one bag.
fn is_split(folder: &Path) -> bool {
    let is_bag = |path: &PathBuf| path.extension().is_some_and(|end| end == "bag");
    entries(folder).is_ok_and(|files| files.len() > 1 && files.iter().all(is_bag))
}

fn is_truth(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.ends_with(".tum") && name.contains("truth")
}

/// A recording that was mapped.
struct Mapped {
    run: LogRun,
    said: Vec<String>,
}

/// Maps a recording as `slam2d run` does.
fn mapped(log: &Path, mut run: LogRun, options: &LogOptions) -> anyhow::Result<Mapped> {
    let (mut reader, progress) = open_robots(log, &[], options)?;
    while let Some(frame) = run.next_frame(&mut reader)? {
        run.step(frame);
    }
    run.finish();
    let name = log.display().to_string();
    progress.end();
    let mut said = reader.notes().sentences(&name);
    said.extend(run.sentences(&name));
    said.extend(run.broken().map(str::to_owned));
    match run.no_map() {
        Some(problem) => {
            said.push(format!("no scan could be used: {problem}"));
            Err(anyhow!(said.join("\n")))
        }
        None => Ok(Mapped { run, said }),
    }
}

/// Largest error after alignment, m; `None` if neither the recording nor its folder has a true path with its stamps.
fn error_m(run: &LogRun, log: &Path) -> Option<f64> {
    let mut truths = vec![log.with_extension("truth.tum")];
    let beside = entries(log.parent()?).ok()?;
    truths.extend(beside.into_iter().filter(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        is_truth(path) && name.starts_with("truth")
    }));
    truths.iter().find_map(|file| {
        let truth = Trajectory::read_tum(&fs::read(file).ok()?[..], "truth").ok()?;
        let errors = truth_errors(&run.trajectory(), &truth, Alignment::Se2).ok()?;
        Some(errors.ate.max)
    })
}

/// Result and largest error of a recording, and what was said about it.
fn outcome(log: &Path, run: LogRun, options: &LogOptions) -> [String; 3] {
    let bytes = fs::read(log).unwrap_or_default();
    if GraphFile::begins(&bytes) && LogFormat::detect(&bytes) != LogFormat::Carmen {
        let name = log.display().to_string();
        return match GraphFile::read(&bytes, &name) {
            Ok((graph, remarks)) => {
                let size = format!("{} poses, {} edges", graph.nodes.len(), graph.edges.len());
                [size, "–".to_owned(), remarks.join("\n")]
            }
            Err(problem) => ["rejected".to_owned(), "–".to_owned(), problem.to_string()],
        };
    }
    match mapped(log, run, options) {
        Ok(Mapped { run, said }) => {
            let error = error_m(&run, log).map_or("–".to_owned(), |m| format!("{m:.3}"));
            [format!("{} scans", run.scans()), error, said.join("\n")]
        }
        Err(problem) => ["rejected".to_owned(), "–".to_owned(), problem.to_string()],
    }
}

/// The recordings of the subfolders of `folder` that have a README, with their results, in Markdown.
///
/// # Errors
/// If the folder cannot be read.
pub fn table(folder: &Path) -> anyhow::Result<String> {
    let mut lines = vec![
        "| recording | result | largest error, m | said |".to_owned(),
        "| --- | --- | ---: | --- |".to_owned(),
    ];
    let row = |log: &Path, run: LogRun, how: &str, options: &LogOptions| {
        let [result, error, said] = outcome(log, run, options);
        let name = log.strip_prefix(folder).unwrap_or(log).display();
        // Sentences name the file, which the row does already.
        let said = said.replace(&format!("{}: ", log.display()), "");
        let said = said.replace(&log.display().to_string(), "it");
        let said = said.replace('|', "\\|").replace('\n', ". ");
        format!("| `{name}`{how} | {result} | {error} | {said} |")
    };
    let plain = LogOptions::default();
    for log in recordings(folder)? {
        lines.push(row(&log, LogRun::default(), "", &plain));
    }
    let [other_day, first_day] = OTHER_DAY.map(|name| folder.join(name));
    if first_day.exists() {
        let first = mapped(&first_day, LogRun::default(), &plain)?;
        let session: Option<Session> = first.run.session();
        let run = session
            .map(|session| LogRun::resume(&session))
            .transpose()?;
        let how = format!(" on the map of `{}`", OTHER_DAY[1]);
        lines.push(row(&other_day, run.unwrap_or_default(), &how, &plain));
    }
    let robots = folder.join(ROBOTS);
    if robots.exists() {
        let all = LogOptions {
            all_robots: true,
            ..plain
        };
        lines.push(row(
            &robots,
            LogRun::default(),
            " with `--all-robots`",
            &all,
        ));
    }
    Ok(lines.join("\n"))
}
