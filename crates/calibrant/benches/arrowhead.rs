//! Benchmark of the arrowhead kernel: elimination of a bordered chain, for scale-bias (D = 1, P = 2) and full
//! (D = 3, P = 12).

use calibrant::arrowhead::{Arrowhead, Increment, Link};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{SMatrix, SVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::hint::black_box;

/// Links of a chain with D + P random "samples" in each interval.
fn links<const D: usize, const P: usize, const ROWS: usize>(intervals: usize) -> Vec<Link<D, P>> {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    (0..intervals)
        .map(|_| {
            let j0 = SMatrix::<f64, ROWS, D>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let j1 = SMatrix::<f64, ROWS, D>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let jp = SMatrix::<f64, ROWS, P>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            let r = SVector::<f64, ROWS>::from_fn(|_, _| rng.random_range(-1.0..1.0));
            Link {
                h00: j0.tr_mul(&j0),
                h01: j0.tr_mul(&j1),
                h11: j1.tr_mul(&j1),
                b0: j0.tr_mul(&jp),
                b1: j1.tr_mul(&jp),
                c: jp.tr_mul(&jp),
                g0: j0.tr_mul(&r),
                g1: j1.tr_mul(&r),
                gp: jp.tr_mul(&r),
            }
        })
        .collect()
}

fn eliminate<const D: usize, const P: usize, const ROWS: usize>(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group(format!("eliminate D={D} P={P}"));
    for intervals in [14, 1000] {
        let links = links::<D, P, ROWS>(intervals);
        let increment =
            Increment { variance: SVector::repeat(0.1), residual: SVector::repeat(0.01), fixed: [false; D] };
        group.throughput(Throughput::Elements(intervals as u64));
        group.bench_function(BenchmarkId::from_parameter(intervals), |bencher| {
            bencher.iter(|| {
                Arrowhead::eliminate(
                    black_box(intervals),
                    |i| links[i].clone(),
                    |_| increment.clone(),
                    SMatrix::zeros(),
                    SVector::zeros(),
                )
            });
        });
    }
    group.finish();
}

criterion_group!(benches, eliminate::<1, 2, 3>, eliminate::<3, 12, 15>);
criterion_main!(benches);
