//! The example that distributes a sweep over a Dask cluster.

use std::path::Path;
use std::process::Command;

#[test]
fn a_cluster_of_two_workers_comes_to_the_same_figures_though_one_is_killed() {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_dask = Command::new(&python)
        .args(["-c", "import dask.distributed"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_dask {
        bench_support::skip::skip(
            "the sweep on a Dask cluster",
            "python3 has no dask; pip install 'dask[distributed]', or set PYTHON to an interpreter that has it",
        );
        return;
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let output = Command::new(&python)
        .arg(root.join("examples/sweep_dask_test.py"))
        .arg(env!("CARGO_BIN_EXE_ch16"))
        .output()
        .expect("it ran before");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
}
