//! Every workload of `docs/performance.md` by its short name: `workloads/lap`.

use criterion::{Criterion, Throughput};
use slam2d_bench::workloads;

pub fn all(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("workloads");
    for workload in workloads() {
        // One run repeats the small ones: the rate is that of single repetitions.
        group.throughput(Throughput::Elements(u64::from(workload.repetitions)));
        // A workload that the filter excludes is not prepared.
        let mut ready = None;
        group.bench_function(workload.id, |bencher| {
            let run = ready.get_or_insert_with(workload.prepare);
            bencher.iter(|| run.once());
        });
    }
    group.finish();
}
