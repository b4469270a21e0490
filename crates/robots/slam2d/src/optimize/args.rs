//! The arguments of `slam2d optimize`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};
use pr_optim::{RobustKernel, Start};

use super::robust::RobustName;
use command_line::numbers;

/// Optimize a pose graph: g2o in, g2o out.
#[derive(Args, Clone, Debug)]
pub struct OptimizeArgs {
    /// Graph to read: VERTEX_SE2, EDGE_SE2 (also _SWITCHABLE and _MAXMIX), FIX; other records are kept unchanged.
    #[arg(value_name = "IN.g2o")]
    pub input: PathBuf,
    /// File for the optimized graph; symbolic links are followed. Without it, no file is written.
    #[arg(short, long, value_name = "OUT.g2o")]
    pub output: Option<PathBuf>,
    /// Gauss–Newton or Levenberg–Marquardt.
    #[arg(long, value_enum, default_value_t = MethodName::Gn)]
    pub method: MethodName,
    /// Initial guess. `auto` tries the file and a spanning tree, and chordal relaxation if they fail; with
    /// a kernel also the solution without it.
    #[arg(long, value_enum, default_value_t = StartName::Auto)]
    pub init: StartName,
    /// Robust kernel: none, huber:W (Mahalanobis norm) or dcs:PHI (squared norm).
    #[arg(long, value_parser = KernelName::from_str, default_value = "none")]
    pub kernel: KernelName,
    /// Selection of inlier loops: none keeps every measurement; gnc and gnc-gm are graduated
    /// non-convexity, pcm is pairwise consistency. Edges between consecutive nodes are always kept.
    #[arg(long, value_enum, default_value_t = RobustName::None)]
    pub robust: RobustName,
    /// Largest number of iterations of one attempt.
    #[arg(long, alias = "max-iters", value_name = "N", default_value_t = 100)]
    pub max_iterations: usize,
    /// Stop when the estimated remaining decrease is less than this share of χ².
    #[arg(long, value_name = "T", default_value = "1e-8", value_parser = numbers::share, allow_hyphen_values = true)]
    pub tolerance: f64,
    /// Optimize this many times and report the fastest; the result is the same.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub repeat: u32,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// `--method`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Gauss–Newton.
    Gn,
    /// Levenberg–Marquardt.
    Lm,
}

/// `--init`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StartName {
    /// Chosen by the solver.
    Auto,
    /// The poses of the file.
    File,
    /// Along a spanning tree of measurements.
    SpanningTree,
    /// Chordal relaxation.
    Chordal,
}

impl StartName {
    /// The solver's value.
    pub fn start(self) -> Start {
        match self {
            Self::Auto => Start::Auto,
            Self::File => Start::Given,
            Self::SpanningTree => Start::SpanningTree,
            Self::Chordal => Start::Chordal,
        }
    }
}

/// `--kernel`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelName(pub RobustKernel);

impl FromStr for KernelName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let positive = |value: &str| {
            value
                .parse()
                .ok()
                .filter(|value: &f64| value.is_finite() && *value > 0.0)
                .ok_or_else(|| format!("`{value}` is not a positive number"))
        };
        match text.split_once(':') {
            None if text == "none" => Ok(Self(RobustKernel::None)),
            Some(("huber", width)) => Ok(Self(RobustKernel::Huber {
                width: positive(width)?,
            })),
            Some(("dcs", phi)) => Ok(Self(RobustKernel::Dcs {
                phi: positive(phi)?,
            })),
            _ => Err("expected none, huber:W or dcs:PHI".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_are_read_with_their_width() {
        let kernel = |text| KernelName::from_str(text).map(|name| name.0);
        assert_eq!(kernel("none"), Ok(RobustKernel::None));
        assert_eq!(kernel("huber:1.5"), Ok(RobustKernel::Huber { width: 1.5 }));
        assert_eq!(kernel("dcs:10"), Ok(RobustKernel::Dcs { phi: 10.0 }));
        for wrong in ["huber", "huber:0", "dcs:x", "cauchy:1", "none:1"] {
            assert!(kernel(wrong).is_err(), "{wrong}");
        }
    }
}
