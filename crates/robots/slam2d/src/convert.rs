//! `slam2d convert`: converts between formats, chosen by file name extension.

use std::fs;
use std::io::BufRead as _;
use std::path::{Path, PathBuf};

use anyhow::bail;
use clap::Args;
use robot_io::carmen::write_carmen;
use robot_io::graph_file::GraphFile;
use robot_io::json_log::FrameLine;
use robot_io::trajectory::{StampedPose, Trajectory};
use serde::Serialize;

use crate::session_file::{is_session, read_session};
use command_line::in_file::InFile as _;
use command_line::log_args::TopicArgs;
use command_line::log_file::{open, open_log};
use command_line::whole_file::{WholeFile, write_whole};

/// Convert a log, a pose graph or a trajectory to another format, chosen by the file name extensions.
///
/// Logs (everything that slam2d run reads) become .clf, .jsonl, or .tum with the odometry. Pose graphs
/// (.g2o .graph .toro .json) become .g2o, .graph, .toro or .json. Trajectories (.tum) become .json.
/// Sessions (.slam2d) become .g2o, .graph, .toro or .json, or .tum with the keyframes.
#[derive(Args, Clone, Debug)]
pub struct ConvertArgs {
    /// File to read.
    input: PathBuf,
    /// File to write.
    output: PathBuf,
    #[command(flatten)]
    options: TopicArgs,
}

/// Content of a file, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Log,
    Graph,
    Trajectory,
    Session,
    Other,
}

impl Kind {
    fn from_extension(extension: &str) -> Self {
        match extension {
            "clf" | "log" | "mcap" | "bag" | "db3" | "jsonl" => Self::Log,
            "g2o" | "graph" | "toro" | "json" => Self::Graph,
            "tum" => Self::Trajectory,
            "slam2d" => Self::Session,
            _ => Self::Other,
        }
    }

    /// The content of an existing file or folder without a known extension: a log of any name, unless it is a graph or a
    /// session.
    fn of(path: &Path) -> Self {
        if is_session(path) {
            return Self::Session;
        }
        let is_graph =
            || open(path).is_ok_and(|mut file| file.fill_buf().is_ok_and(GraphFile::begins));
        match (path.exists(), is_graph()) {
            (true, true) => Self::Graph,
            (true, false) => Self::Log,
            (false, _) => Self::Other,
        }
    }

    fn advice(self) -> &'static str {
        match self {
            Self::Log => "convert a log to .clf, .jsonl, or .tum with its odometry",
            Self::Graph => "convert a pose graph to .g2o, .graph, .toro or .json",
            Self::Trajectory => "convert a trajectory to .json",
            Self::Session => {
                "convert a session to .g2o, .graph, .toro or .json, or .tum with its keyframes"
            }
            Self::Other => {
                "use a log that slam2d run reads, a pose graph (.g2o .graph .toro .json), a trajectory (.tum) or a session (.slam2d)"
            }
        }
    }
}

/// Runs the conversion.
///
/// # Errors
/// If a file cannot be used, or there is no such conversion.
pub fn run(args: &ConvertArgs) -> anyhow::Result<()> {
    let [from, to] = [&args.input, &args.output].map(|path| extension(path));
    let kind = match Kind::from_extension(&from) {
        // The folder of a run stands for its session.
        Kind::Other => Kind::of(&args.input),
        kind => kind,
    };
    if is_same_file(&args.input, &args.output) {
        bail!(
            "{} is both input and output; choose another output file",
            args.input.display()
        );
    }
    match (kind, to.as_str()) {
        (Kind::Log, "clf" | "log" | "jsonl" | "tum") => convert_log(args, &to),
        (Kind::Graph, "g2o" | "graph" | "toro" | "json") => convert_graph(args, &to),
        (Kind::Trajectory, "json") => convert_trajectory(args),
        (Kind::Session, "g2o" | "graph" | "toro" | "json" | "tum") => convert_session(args, &to),
        _ => bail!(
            "{} cannot be converted to {}; {}",
            args.input.display(),
            args.output.display(),
            kind.advice()
        ),
    }
}

/// Whether both exist and are the same file.
fn is_same_file(a: &Path, b: &Path) -> bool {
    let [a, b] = [a, b].map(fs::canonicalize);
    a.is_ok_and(|a| b.is_ok_and(|b| a == b))
}

fn extension(path: &Path) -> String {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    extension.to_ascii_lowercase()
}

fn convert_log(args: &ConvertArgs, to: &str) -> anyhow::Result<()> {
    let (mut reader, mut progress) = open_log(&args.input, &[], &args.options.0)?;
    // If the log cannot be read, the output is left unchanged.
    let mut next = reader.next_frame()?;
    let mut file: Option<WholeFile> = None;
    let mut odometry: Vec<StampedPose> = Vec::new();
    let mut count = 0;
    while let Some(frame) = next {
        count += 1;
        progress.report(count);
        if to == "tum" {
            let is_later = odometry
                .last()
                .is_none_or(|last| frame.stamp_s > last.stamp_s);
            if let (Some(pose), true) = (frame.odometry, is_later) {
                odometry.push(StampedPose {
                    stamp_s: frame.stamp_s,
                    pose,
                });
            }
        } else {
            let file = match &mut file {
                Some(file) => file,
                none => none.insert(WholeFile::create(&args.output).in_file(&args.output)?),
            };
            match to {
                "jsonl" => FrameLine::from(&frame).write(file).in_file(&args.output)?,
                _ => write_carmen(&frame, file).in_file(&args.output)?,
            }
        }
        next = reader.next_frame()?;
    }
    progress.end();
    for sentence in reader.notes().sentences(&args.input.display().to_string()) {
        eprintln!("slam2d: {sentence}");
    }
    if let Some(file) = file {
        file.finish().in_file(&args.output)?;
    }
    if to == "tum" {
        if odometry.is_empty() {
            bail!(
                "{} has no odometry, so it has no trajectory to convert",
                args.input.display()
            );
        }
        let mut text = Vec::new();
        let written = Trajectory::new(odometry).write_tum(&mut text);
        written
            .and_then(|()| write_whole(&args.output, &text))
            .in_file(&args.output)?;
    }
    Ok(())
}

fn convert_graph(args: &ConvertArgs, to: &str) -> anyhow::Result<()> {
    let bytes = fs::read(&args.input).in_file(&args.input)?;
    let (graph, remarks) = GraphFile::read(&bytes, &args.input.display().to_string())?;
    for remark in remarks {
        eprintln!("slam2d: {remark}");
    }
    write_graph(args, &graph, to)
}

fn write_graph(args: &ConvertArgs, graph: &GraphFile, to: &str) -> anyhow::Result<()> {
    let text = match to {
        "g2o" => graph.to_g2o(),
        "json" => json(graph),
        _ => graph.to_toro(),
    };
    write_whole(&args.output, text.as_bytes()).in_file(&args.output)
}

fn convert_session(args: &ConvertArgs, to: &str) -> anyhow::Result<()> {
    let (session, _) = read_session(&args.input)?;
    if to != "tum" {
        return write_graph(args, &GraphFile::from_pose_graph(&session.graph()), to);
    }
    let keyframes = session.snapshot.keyframes.iter().zip(session.poses());
    let poses = keyframes.map(|(keyframe, pose)| StampedPose {
        stamp_s: keyframe.stamp_s,
        pose,
    });
    let mut text = Vec::new();
    let written = Trajectory::new(poses.collect()).write_tum(&mut text);
    let written = written.and_then(|()| write_whole(&args.output, &text));
    written.in_file(&args.output)
}

fn convert_trajectory(args: &ConvertArgs) -> anyhow::Result<()> {
    let name = args.input.display().to_string();
    let trajectory = Trajectory::read_tum(open(&args.input)?, &name)?;
    write_whole(&args.output, json(&trajectory.poses()).as_bytes()).in_file(&args.output)
}

fn json(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string(value).expect("plain numbers and lists");
    text.push('\n');
    text
}
