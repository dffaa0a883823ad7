//! One interface to the networks of all kinds: forward pass, backward pass, and weights.

use vertifleet_observe::Shape;

use crate::nn::architecture::{Architecture, Layers, check_size};
use crate::nn::batch::{Inputs, Outputs, Slopes};
use crate::nn::gcaps::{Gcaps, GcapsSpace};
use crate::nn::init;
use crate::nn::layout::{Layout, Tensors};
use crate::nn::mlp::{Mlp, MlpSpace};

/// A policy's network: its sizes and the layout of its weights, but not the weights themselves.
#[derive(Debug, Clone)]
pub struct NeuralNetwork {
    architecture: Architecture,
    shape: Shape,
    layout: Layout,
    /// Number of weights at the front that are used in products only. Their slopes are not summed
    /// over batches.
    folded: usize,
    /// Number of entries of all products.
    derived: usize,
    body: Body,
}

#[derive(Debug, Clone)]
enum Body {
    Gcaps(Box<Gcaps>),
    Mlp(Mlp),
}

/// The weights of a network with the products derived from them. Both change together, in
/// [`NeuralNetwork::update`].
#[derive(Debug, Clone)]
pub struct Weights {
    params: Vec<f32>,
    products: Vec<f32>,
}

/// The working memory of passes over batches up to a largest size. A backward pass reads the values
/// that the forward pass before it stored here.
#[derive(Debug)]
pub struct Workspace {
    most: usize,
    batch: usize,
    vertiports: usize,
    outputs: Outputs,
    body: BodySpace,
}

#[derive(Debug)]
enum BodySpace {
    Gcaps(Box<GcapsSpace>),
    Mlp(MlpSpace),
}

/// A gradient, summed over any number of batches.
#[derive(Debug, Clone)]
pub struct Gradient {
    /// Slopes of the weights, then those of the products.
    slopes: Vec<f32>,
    folded: usize,
}

impl NeuralNetwork {
    /// The network with these sizes.
    ///
    /// # Errors
    /// Returns an error if a size is 0 or absurdly large, or if sizes do not fit together; the
    /// message names the size.
    pub fn new(architecture: Architecture, shape: Shape) -> Result<Self, String> {
        check_size("vertiports", shape.vertiports)?;
        check_size("node_features", shape.node_features)?;
        check_size("aircraft_features", shape.aircraft_features)?;
        let (body, layout, derived, folded) = match architecture.layers() {
            Layers::Graph(settings) => {
                let (body, layout, products, folded) = Gcaps::new(settings, shape)?;
                (Body::Gcaps(Box::new(body)), layout, products.len(), folded)
            }
            Layers::Plain(settings) => {
                let (body, layout) = Mlp::new(settings, shape)?;
                (Body::Mlp(body), layout, 0, 0)
            }
        };
        Ok(Self { architecture, shape, layout, folded, derived, body })
    }

    /// The kind of the policy, with its sizes.
    pub fn architecture(&self) -> &Architecture {
        &self.architecture
    }

    /// The sizes of the features.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// The place of each tensor among the weights.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The initial parameters, a function of the seed alone.
    pub fn init(&self, seed: u64) -> Vec<f32> {
        init::draw(&self.layout, seed)
    }

    /// The weights with these parameters, which must be in the order of the layout.
    ///
    /// # Panics
    /// Panics if there are more or fewer parameters than the layout has.
    pub fn weights(&self, params: Vec<f32>) -> Weights {
        let mut weights = Weights { params, products: vec![0.0; self.derived] };
        self.update(&mut weights, |_| ());
        weights
    }

    /// Changes the parameters of weights, and updates the products derived from them.
    ///
    /// # Panics
    /// Panics if the weights belong to another network.
    pub fn update(&self, weights: &mut Weights, change: impl FnOnce(&mut [f32])) {
        self.tensors(weights);
        change(&mut weights.params);
        match &self.body {
            Body::Gcaps(body) => body.prepare(&weights.params, &mut weights.products),
            Body::Mlp(_) => {}
        }
    }

    /// Allocates the working memory for passes of up to `most` decisions.
    pub fn workspace(&self, most: usize) -> Workspace {
        let vertiports = self.shape.vertiports;
        Workspace {
            most,
            batch: 0,
            vertiports,
            outputs: Outputs { logits: vec![0.0; most * vertiports], values: vec![0.0; most] },
            body: match &self.body {
                Body::Gcaps(body) => BodySpace::Gcaps(Box::new(body.space(most))),
                Body::Mlp(body) => BodySpace::Mlp(body.space(most)),
            },
        }
    }

    /// A gradient of zeros.
    pub fn gradient(&self) -> Gradient {
        Gradient { slopes: vec![0.0; self.layout.len() + self.derived], folded: self.folded }
    }

    /// Computes the logits and values of a batch and leaves them in the workspace.
    ///
    /// # Panics
    /// Panics if the batch is larger than the workspace, or if an argument has another network's
    /// shape.
    pub fn forward(&self, weights: &Weights, inputs: Inputs<'_>, workspace: &mut Workspace) {
        self.check(inputs, workspace);
        let tensors = self.tensors(weights);
        workspace.batch = inputs.batch;
        let outputs = &mut workspace.outputs;
        match (&self.body, &mut workspace.body) {
            (Body::Gcaps(body), BodySpace::Gcaps(space)) => {
                body.forward(tensors, inputs, space, outputs);
            }
            (Body::Mlp(body), BodySpace::Mlp(space)) => {
                body.forward(tensors, inputs, space, outputs);
            }
            _ => panic!("the workspace is of another kind of network"),
        }
    }

    /// Adds the gradient of a loss with these slopes. The batch must be that of the latest
    /// [`forward`](Self::forward).
    ///
    /// # Panics
    /// Panics if an argument has another network's shape, or if the batch has another size than the
    /// latest.
    pub fn backward(
        &self,
        weights: &Weights,
        inputs: Inputs<'_>,
        slopes: Slopes<'_>,
        workspace: &mut Workspace,
        gradient: &mut Gradient,
    ) {
        self.check(inputs, workspace);
        let tensors = self.tensors(weights);
        assert_eq!(inputs.batch, workspace.batch, "the latest forward pass was of this batch");
        assert_eq!(slopes.logits.len(), inputs.mask.len(), "a slope for every logit");
        assert_eq!(slopes.values.len(), inputs.batch, "a slope for every value");
        let gradient = &mut gradient.slopes;
        match (&self.body, &mut workspace.body) {
            (Body::Gcaps(body), BodySpace::Gcaps(space)) => {
                body.backward(tensors, inputs, slopes, space, gradient);
            }
            (Body::Mlp(body), BodySpace::Mlp(space)) => {
                body.backward(tensors, inputs, slopes, space, gradient);
            }
            _ => panic!("the workspace is of another kind of network"),
        }
    }

    /// Completes a summed gradient and returns the slopes of the weights, in the order of the
    /// layout. Call it once per sum, and clear the gradient before the next.
    ///
    /// # Panics
    /// Panics if an argument belongs to another network.
    pub fn finish<'a>(&self, weights: &Weights, gradient: &'a mut Gradient) -> &'a mut [f32] {
        self.tensors(weights);
        match &self.body {
            Body::Gcaps(body) => body.finish(&weights.params, &mut gradient.slopes),
            Body::Mlp(_) => {}
        }
        &mut gradient.slopes[..self.layout.len()]
    }

    fn tensors<'a>(&self, weights: &'a Weights) -> Tensors<'a> {
        let Weights { params, products } = weights;
        assert_eq!(params.len(), self.layout.len(), "weights of this network");
        assert_eq!(products.len(), self.derived, "products of this network");
        Tensors { params, derived: products }
    }

    fn check(&self, inputs: Inputs<'_>, workspace: &Workspace) {
        let Shape { vertiports, node_features, aircraft_features } = self.shape;
        let batch = inputs.batch;
        assert!(
            batch <= workspace.most,
            "the workspace has room for {} decisions, not {batch}",
            workspace.most
        );
        assert_eq!(workspace.vertiports, vertiports, "a workspace of this network");
        assert_eq!(
            inputs.nodes.len(),
            batch * vertiports * node_features,
            "node features of the batch"
        );
        assert_eq!(
            inputs.aircraft.len(),
            batch * aircraft_features,
            "aircraft features of the batch"
        );
        assert_eq!(inputs.mask.len(), batch * vertiports, "mask of the batch");
        assert_eq!(inputs.clock.len(), batch, "clocks of the batch");
        if self.architecture.edges().is_some() {
            assert_eq!(inputs.edges.len(), batch * vertiports * vertiports, "edges of the batch");
        }
    }
}

impl Weights {
    /// The parameters, in the order of the layout.
    pub fn params(&self) -> &[f32] {
        &self.params
    }
}

impl Workspace {
    /// Logits of the latest forward pass [B x N]; minus infinity where the mask is 0.
    pub fn logits(&self) -> &[f32] {
        &self.outputs.logits[..self.batch * self.vertiports]
    }

    /// Values of the latest forward pass `[B]`.
    pub fn values(&self) -> &[f32] {
        &self.outputs.values[..self.batch]
    }
}

impl Gradient {
    /// Sets all slopes to 0.
    pub fn clear(&mut self) {
        self.sums_mut().fill(0.0);
    }

    /// The sums over batches, so that gradients can be added up; only [`NeuralNetwork::finish`]
    /// turns them into slopes.
    pub fn sums(&self) -> &[f32] {
        &self.slopes[self.folded..]
    }

    /// The sums of [`sums`](Self::sums), mutable.
    pub fn sums_mut(&mut self) -> &mut [f32] {
        &mut self.slopes[self.folded..]
    }
}
