//! `slam2d map`: writes the map of a run for Nav2's map_server.

use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use clap::{Args, ValueEnum};
use robot_io::json_log::FrameLine;
use robot_io::log::LogError;
use robot_io::map_image::{
    MapError, MapImage, MapMode, NoReturn, build_map, build_session_map, finest_map,
};

use crate::run_folder::KEYFRAMES;
use crate::session_file::read_session;
use command_line::in_file::InFile as _;
use command_line::log_file::open;
use command_line::numbers;
use command_line::output::say;
use command_line::whole_file::WholeFile;

/// Write the map of a run as an image with a YAML file, for Nav2's map_server.
#[derive(Args, Clone, Debug)]
pub struct MapArgs {
    /// A session, or a folder that slam2d run -o DIR wrote.
    #[arg(value_name = "SESSION|DIR")]
    run: PathBuf,
    /// The YAML file; the image is written next to it.
    #[arg(short = 'o', long, value_name = "MAP.yaml")]
    output: PathBuf,
    /// Side of a cell, m.
    #[arg(long, default_value = "0.05", value_parser = numbers::cell_m, allow_hyphen_values = true)]
    resolution: f64,
    /// Mark free space along beams without a return, up to the sensor's limit (REP 117); needs the folder of a run.
    #[arg(long)]
    free_space: bool,
    /// Meaning of a pixel: occupied, free or unknown, or the probability.
    #[arg(long, value_enum, default_value = "trinary")]
    mode: ModeArg,
    /// Format of the image; scale needs png.
    #[arg(long, value_enum)]
    image: Option<ImageArg>,
}

/// Command line values of [`MapMode`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ModeArg {
    /// Black, white and grey.
    Trinary,
    /// Shades of grey; unknown is transparent.
    Scale,
}

/// Formats of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ImageArg {
    /// Portable grey map.
    Pgm,
    /// Portable network graphics.
    Png,
}

/// Writes the map and prints its cell counts.
///
/// # Errors
/// If a file cannot be used, or the map is too large.
pub fn run(args: &MapArgs) -> anyhow::Result<()> {
    let extension = args.output.extension().unwrap_or_default();
    if extension != "yaml" && extension != "yml" {
        bail!("{} must end in .yaml", args.output.display());
    }
    let (mode, image) = match (args.mode, args.image) {
        (ModeArg::Scale, Some(ImageArg::Pgm)) => bail!(
            "--mode scale marks unknown cells by transparency, which PGM does not have; use --image png"
        ),
        (ModeArg::Scale, _) => (MapMode::Scale, ImageArg::Png),
        (ModeArg::Trinary, image) => (MapMode::Trinary, image.unwrap_or(ImageArg::Pgm)),
    };
    // A folder's keyframes have all beams, a session has filtered scans.
    if args.free_space && !args.run.is_dir() {
        bail!(
            "{} stores only beams with a return, so it has no free space along the others; pass the folder of the run",
            args.run.display()
        );
    }
    let map = if args.run.is_dir() {
        let no_return = NoReturn::free_if(args.free_space);
        let lines = keyframes(&args.run)?;
        as_fine_as_asked(args, |cell_m| build_map(&lines, cell_m, no_return))?
    } else {
        let session = read_session(&args.run)?.0;
        as_fine_as_asked(args, |cell_m| build_session_map(&session, cell_m))?
    };
    let picture = args.output.with_extension(match image {
        ImageArg::Pgm => "pgm",
        ImageArg::Png => "png",
    });
    let name = picture.file_name().unwrap_or_default().to_string_lossy();
    let yaml = map.yaml(&name, mode);
    // Both are complete before either replaces an older one.
    let written = |path: &Path, write: &dyn Fn(&mut WholeFile) -> io::Result<()>| {
        let mut file = WholeFile::create(path).in_file(path)?;
        write(&mut file).and_then(|()| file.flush()).in_file(path)?;
        anyhow::Ok(file)
    };
    let image = written(&picture, &|out| match image {
        ImageArg::Pgm => map.write_pgm(out),
        ImageArg::Png => map.write_png(out, mode),
    })?;
    let about = written(&args.output, &|out| out.write_all(yaml.as_bytes()))?;
    image.finish().in_file(&picture)?;
    about.finish().in_file(&args.output)?;
    let [occupied, free, unknown] = map.counts();
    say!(
        "{} × {} cells of {} m: {occupied} occupied, {free} free, {unknown} unknown",
        map.width,
        map.height,
        map.cell_m
    );
    Ok(())
}

/// The map with the cells that were asked for.
fn as_fine_as_asked(
    args: &MapArgs,
    draw: impl Fn(f64) -> Result<MapImage, MapError>,
) -> anyhow::Result<MapImage> {
    draw(args.resolution)
        .map_err(|error| match finest_map(args.resolution, draw) {
            Ok(map) => anyhow!("{error}; --resolution {} fits", map.cell_m),
            Err(_) => error.into(),
        })
        .in_file(&args.run)
}

/// The keyframes of a run with their poses.
fn keyframes(folder: &Path) -> anyhow::Result<Vec<FrameLine>> {
    let path = folder.join(KEYFRAMES);
    if !fs::metadata(&path).is_ok_and(|about| about.is_file()) {
        bail!(
            "{} has no {KEYFRAMES}; pass a session, or a folder that slam2d run -o DIR wrote",
            folder.display()
        );
    }
    let mut lines = Vec::new();
    let name = path.display().to_string();
    for (number, line) in io::BufRead::lines(open(&path)?).enumerate() {
        let line = FrameLine::with_pose(&line.in_file(&path)?);
        lines.push(line.map_err(|problem| LogError::NoScans {
            name: name.clone(),
            detail: format!("line {}: {problem}", number + 1),
        })?);
    }
    Ok(lines)
}
