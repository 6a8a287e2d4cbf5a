//! Every operation, with the same bits in any width.

use super::*;

/// Rows with ordinary, negative, huge, tiny and equal numbers.
fn rows(salt: u64) -> [Row; WIDEST] {
    let number = |k: u64| {
        let bits = (k + salt).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mantissa = (bits >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        mantissa * [1.0, 1e-9, 1e12, 3.0, 1e-160][(bits % 5) as usize]
    };
    std::array::from_fn(|i| std::array::from_fn(|j| number((4 * i + j) as u64)))
}

/// What every operation makes of two times eight rows: bits, lane by lane.
struct Everything {
    a: [Row; WIDEST],
    b: [Row; WIDEST],
}

impl Work for Everything {
    type Output = Vec<u64>;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Vec<u64> {
        let mut bits = vec![Vec::new(); WIDEST];
        for first in (0..WIDEST).step_by(N::COUNT) {
            let a = side_by_side::<N, _>(|k| &self.a[first + k]);
            let b = side_by_side::<N, _>(|k| &self.b[first + k]);
            let [x, y, z, w] = N::gather(processor, a);
            let difference = N::gather_difference(processor, a, b);
            let mixed = N::gather_difference_and_sum(processor, a, b);
            let spread = N::spread(processor, &self.a[3]);
            let (zero, two) = (N::splat(processor, 0.0), N::splat(processor, 2.0));
            let positive = N::choose(x.exceeds(zero), x, -x);
            let (fraction, exponent) = positive.split();
            let mut column = [0.0; WIDEST];
            (y * two).store(&mut column);
            let loaded = N::load(processor, &column);
            let crossed = cross([x, y, z], [w, x, y]);
            let all = [x, y, z, w, x + y, x - y, x * y, x / w, -z, positive.sqrt()];
            let all = all.into_iter().chain([fraction, exponent, loaded]);
            let all = all
                .chain(difference)
                .chain(mixed)
                .chain(spread)
                .chain(crossed);
            let back = N::rows([x, y, z, w]);
            let held = N::count(x.exceeds(y)) as usize;
            for (lane, numbers) in bits[first..first + N::COUNT].iter_mut().enumerate() {
                numbers.extend(back[lane].row().map(f64::to_bits));
            }
            let counted = (0..N::COUNT).filter(|k| self.a[first + k][0] > self.a[first + k][1]);
            assert_eq!(held, counted.count());
            for operation in all {
                let numbers = operation.numbers();
                for lane in 0..N::COUNT {
                    bits[first + lane].push(numbers[lane].to_bits());
                }
            }
        }
        bits.concat()
    }
}

/// What the operations on one row make of sixteen rows.
struct OfRows {
    a: [Row; WIDEST],
    b: [Row; WIDEST],
}

impl Work for OfRows {
    type Output = Vec<u64>;

    #[inline(always)]
    fn run<N: Lanes>(self, processor: N::Processor) -> Vec<u64> {
        let mut bits = Vec::new();
        for (a, b) in self.a.iter().zip(&self.b) {
            let (a, b) = (N::Quad::load(processor, a), N::Quad::load(processor, b));
            let three = N::Quad::repeat(processor, 3.0);
            for quad in [a + b, a - b, a * b * three] {
                bits.extend(quad.row().map(f64::to_bits));
            }
            bits.push(a.length_squared().to_bits());
        }
        bits
    }
}

#[test]
fn every_operation_has_the_same_bits_in_any_width() {
    for salt in [1, 100, 10_000] {
        let (a, b) = (rows(salt), rows(salt + 50));
        let plain = Processor::Scalar.run(Everything { a, b });
        let plain_rows = Processor::Scalar.run(OfRows { a, b });
        assert_eq!(plain.len(), 8 * (4 + 10 + 3 + 15));
        for processor in Processor::all() {
            assert_eq!(processor.run(Everything { a, b }), plain, "{processor}");
            assert_eq!(processor.run(OfRows { a, b }), plain_rows, "{processor}");
        }
    }
}

#[test]
fn lanes_that_are_chosen_are_those_of_the_mask() {
    struct Choose([Row; WIDEST]);
    impl Work for Choose {
        type Output = Vec<f64>;

        #[inline(always)]
        fn run<N: Lanes>(self, processor: N::Processor) -> Vec<f64> {
            let mut chosen = Vec::new();
            for first in (0..WIDEST).step_by(N::COUNT) {
                let rows = side_by_side::<N, _>(|k| &self.0[first + k]);
                let [x, y, ..] = N::gather(processor, rows);
                let larger = N::choose(x.exceeds(y), x, y);
                chosen.extend_from_slice(&larger.numbers()[..N::COUNT]);
            }
            chosen
        }
    }
    let rows = rows(7);
    let larger: Vec<f64> = rows.iter().map(|[x, y, ..]| x.max(*y)).collect();
    for processor in Processor::all() {
        assert_eq!(processor.run(Choose(rows)), larger, "{processor}");
    }
}
