//! `cargo run --release -p solver_peers -- [--rounds N] FILE.g2o…` prints one table in Markdown.

use std::path::Path;
use std::process::ExitCode;

use pr_optim::Start;
use pr_optim::g2o::G2oFile;
use solver_peers::arael_peer::Arael;
use solver_peers::factrs_peer::Factrs;
use solver_peers::ours::Ours;
use solver_peers::{Peer, Timing};

/// The fastest of one solver's runs, and the χ² that all of them reach.
struct Row {
    name: &'static str,
    cold: Timing,
    warm: Option<Timing>,
}

fn main() -> ExitCode {
    let mut rounds = 20;
    let mut files = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument != "--rounds" {
            files.push(argument);
            continue;
        }
        match arguments.next().and_then(|count| count.parse().ok()) {
            Some(count) if count > 0 => rounds = count,
            _ => {
                eprintln!("--rounds needs a number of at least 1");
                return ExitCode::from(2);
            }
        }
    }
    if files.is_empty() {
        eprintln!("usage: solver_peers [--rounds N] FILE.g2o…");
        return ExitCode::from(2);
    }
    println!(
        "Fastest of {rounds} interleaved rounds, one thread, ms of CPU time. \
         The ratio is ours to the solver's.\n"
    );
    println!("| graph | solver | warm | ratio | cold | ratio | iterations | χ² |");
    println!("|---|---|--:|--:|--:|--:|--:|--:|");
    for file in &files {
        if let Err(message) = compare(Path::new(file), rounds) {
            eprintln!("{file}: {message}");
            return ExitCode::from(2);
        }
    }
    ExitCode::SUCCESS
}

fn compare(path: &Path, rounds: usize) -> Result<(), String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let problem = G2oFile::parse(&text)
        .map_err(|error| error.to_string())?
        .problem;
    let mut peers: Vec<Box<dyn Peer>> = vec![
        Box::new(Ours::new(problem.clone(), Start::Auto)),
        Box::new(Ours::new(problem.clone(), Start::Given)),
        Box::new(Arael::new(problem)),
        Box::new(Factrs::new(path)),
    ];
    let mut rows: Vec<Row> = peers
        .iter_mut()
        .map(|peer| Row {
            name: peer.name(),
            cold: peer.solve_cold(),
            warm: peer.solve_warm(),
        })
        .collect();
    for _ in 1..rounds {
        for (row, peer) in rows.iter_mut().zip(&mut peers) {
            keep_faster(&mut row.cold, peer.solve_cold());
            if let (Some(best), Some(timing)) = (&mut row.warm, peer.solve_warm()) {
                keep_faster(best, timing);
            }
        }
    }
    print_rows(path, &rows);
    Ok(())
}

fn keep_faster(best: &mut Timing, timing: Timing) {
    if timing.cpu_ms < best.cpu_ms {
        *best = timing;
    }
}

fn print_rows(path: &Path, rows: &[Row]) {
    let graph = path.file_stem().unwrap_or_default().to_string_lossy();
    let ours = &rows[0];
    for row in rows {
        let warm = row
            .warm
            .map_or("–".to_owned(), |timing| format!("{:.3}", timing.cpu_ms));
        let warm_ratio = match (ours.warm, row.warm) {
            (Some(ours), Some(theirs)) => format!("{:.2}", ours.cpu_ms / theirs.cpu_ms),
            _ => "–".to_owned(),
        };
        let iterations = match row.cold.iterations {
            0 => "–".to_owned(),
            count => count.to_string(),
        };
        println!(
            "| {graph} | {} | {warm} | {warm_ratio} | {:.3} | {:.2} | {iterations} | {:.6} |",
            row.name,
            row.cold.cpu_ms,
            ours.cold.cpu_ms / row.cold.cpu_ms,
            row.cold.chi2,
        );
    }
}
