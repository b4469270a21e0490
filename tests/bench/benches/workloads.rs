//! Every workload of `docs/performance.md` under criterion: `cargo bench -p slam2d_bench`.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use slam2d_bench::workloads;

fn all(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("workloads");
    for workload in workloads() {
        // One run repeats the small ones: the rate is of single repetitions.
        group.throughput(Throughput::Elements(u64::from(workload.repetitions)));
        // A workload that the filter leaves out is not prepared.
        let mut ready = None;
        group.bench_function(workload.id, |bencher| {
            let run = ready.get_or_insert_with(workload.prepare);
            bencher.iter(|| run.once());
        });
    }
    group.finish();
}

criterion_group!(benches, all);
criterion_main!(benches);
