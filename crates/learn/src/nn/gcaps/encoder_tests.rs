//! Compares the encoder with a literal reading of Eq. 18 and 19: an explicit Laplacian, its square,
//! and weights W_pa, in double precision. Also checks its slopes, including those that go through
//! products of weights.

use crate::nn::GcapsSettings;
use crate::nn::Shape;
use crate::nn::batch::Inputs;
use crate::nn::gcaps::{AnyEncoder, Gcaps};
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::slope_tests::{check, numbers, weighted};

const VERTIPORTS: usize = 5;
const FEATURES: usize = 14;
const WIDTH: usize = 8;
const BATCH: usize = 2;

struct Case {
    gcaps: Gcaps,
    layout: Layout,
    products: usize,
    params: Vec<f32>,
    nodes: Vec<f32>,
}

impl Case {
    fn new() -> Self {
        let shape =
            Shape { vertiports: VERTIPORTS, node_features: FEATURES, aircraft_features: 12 };
        let settings = GcapsSettings::of_sizes(WIDTH, 2);
        let (gcaps, layout, products, _) = Gcaps::new(&settings, shape).expect("sizes that fit");
        let params = numbers(layout.len(), 1).iter().map(|x| 0.5 * x).collect();
        let nodes = numbers(BATCH * VERTIPORTS * FEATURES, 2);
        Self { gcaps, products: products.len(), layout, params, nodes }
    }

    fn inputs(&self) -> Inputs<'_> {
        Inputs {
            batch: BATCH,
            nodes: &self.nodes,
            aircraft: &[],
            mask: &[],
            edges: &[],
            clock: &[],
        }
    }

    fn derived(&self, params: &[f32]) -> Vec<f32> {
        let mut derived = vec![0.0; self.products];
        self.gcaps.prepare(params, &mut derived);
        derived
    }

    fn capsules(&self, params: &[f32]) -> Vec<f32> {
        let mut space = self.gcaps.space(BATCH);
        let derived = self.derived(params);
        let tensors = Tensors { params, derived: &derived };
        self.gcaps.encoder.forward(tensors, self.inputs(), &mut space.encoder);
        self.gcaps.encoder.read(&space.encoder, BATCH).to_vec()
    }
}

/// A matrix in double precision, as rows.
type Rows = Vec<Vec<f64>>;

fn rows(flat: &[f32], columns: usize) -> Rows {
    flat.chunks(columns).map(|row| row.iter().map(|&x| f64::from(x)).collect()).collect()
}

fn product(left: &Rows, right: &Rows) -> Rows {
    let column = |row: &Vec<f64>, at: usize| row.iter().zip(right).map(|(x, y)| x * y[at]).sum();
    left.iter().map(|row| (0..right[0].len()).map(|at| column(row, at)).collect()).collect()
}

/// f_p of one sample: ReLU of the sum over a of L^a F^p W_pa, with W_pa = V_pa / N^a.
fn eq_18(power: i32, f_0: &Rows, hops: [Slot; 3], params: &[f32]) -> Rows {
    let n = VERTIPORTS as f64;
    // D - A of the complete graph has N - 1 on the diagonal and -1 elsewhere.
    let laplacian: Rows = (0..VERTIPORTS)
        .map(|i| (0..VERTIPORTS).map(|j| if i == j { n - 1.0 } else { -1.0 }).collect())
        .collect();
    let raised: Rows = f_0.iter().map(|row| row.iter().map(|x| x.powi(power)).collect()).collect();
    let mut propagated = raised;
    let mut sum = vec![vec![0.0; WIDTH]; VERTIPORTS];
    for (a, hop) in (0..).zip(hops) {
        let mut weight = rows(hop.part(params), WIDTH);
        weight.iter_mut().flatten().for_each(|v| *v /= n.powi(a));
        for (sum, term) in
            sum.iter_mut().flatten().zip(product(&propagated, &weight).iter().flatten())
        {
            *sum += term;
        }
        propagated = product(&laplacian, &propagated);
    }
    sum.iter_mut().flatten().for_each(|x| *x = x.max(0.0));
    sum
}

#[test]
fn capsules_are_those_of_equations_18_and_19() {
    let case = Case::new();
    let AnyEncoder::OfThePaper(paper) = &case.gcaps.encoder else {
        panic!("these are the settings of the paper")
    };
    let weights = &paper.1;
    let found = case.capsules(&case.params);
    let w_0 = rows(weights.node.weight.part(&case.params), WIDTH);
    let b_0 = weights.node.bias.part(&case.params);
    for (sample, nodes) in case.nodes.chunks(VERTIPORTS * FEATURES).enumerate() {
        let mut f_0 = product(&rows(nodes, FEATURES), &w_0);
        for row in &mut f_0 {
            row.iter_mut().zip(b_0).for_each(|(x, b)| *x += f64::from(*b));
        }
        let f_1 = eq_18(1, &f_0, weights.first, &case.params);
        let f_2 = eq_18(2, &f_0, weights.second, &case.params);
        for (node, (f_1, f_2)) in f_1.iter().zip(&f_2).enumerate() {
            let capsule = &found[(sample * VERTIPORTS + node) * 2 * WIDTH..][..2 * WIDTH];
            for (found, expected) in capsule.iter().zip(f_1.iter().chain(f_2)) {
                assert!((f64::from(*found) - expected).abs() < 1e-5, "{found} is not {expected}");
            }
        }
    }
}

#[test]
fn slopes_of_the_capsules() {
    let case = Case::new();
    let weights = numbers(BATCH * VERTIPORTS * 2 * WIDTH, 3);
    let derived = case.derived(&case.params);
    let tensors = Tensors { params: &case.params, derived: &derived };
    let mut space = case.gcaps.space(BATCH);
    case.gcaps.encoder.forward(tensors, case.inputs(), &mut space.encoder);
    let (mut slopes, mut gradient) =
        (weights.clone(), vec![0.0; case.layout.len() + case.products]);
    case.gcaps.encoder.backward(
        tensors,
        case.inputs(),
        &mut space.encoder,
        &mut slopes,
        &mut gradient,
    );
    case.gcaps.finish(&case.params, &mut gradient);
    for tensor in case.layout.tensors() {
        let span = tensor.offset..tensor.offset + tensor.len();
        check(&tensor.name, &case.params[span.clone()], &gradient[span.clone()], 1, |part| {
            let mut params = case.params.clone();
            params[span.clone()].copy_from_slice(part);
            weighted(&case.capsules(&params), &weights)
        });
    }
}
