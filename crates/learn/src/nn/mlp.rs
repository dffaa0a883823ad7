//! The paper's baseline (§V.B): plain layers on the flattened features, with the same mask and
//! value head as `gcaps`.

use vertifleet_observe::Shape;

use crate::nn::architecture::{MlpSettings, check_size};
use crate::nn::batch::{Inputs, Outputs, Slopes};
use crate::nn::init::{BEFORE_RELU, LOGITS};
use crate::nn::layout::{Layout, Tensors};
use crate::nn::linear::{Linear, add_rows, add_weight_slopes, repeat};
use crate::nn::product::{Matrix, MatrixMut, Write, multiply};
use crate::nn::relu;
use crate::nn::value_head::ValueHead;

/// The network's tensors and sizes.
#[derive(Debug, Clone)]
pub(crate) struct Mlp {
    shape: Shape,
    layers: Vec<Linear>,
    logits: Linear,
    head: ValueHead,
}

/// The working memory of a pass; rows are samples.
#[derive(Debug)]
pub(crate) struct MlpSpace {
    features: Vec<f32>,
    /// Outputs of each layer.
    outputs: Vec<Vec<f32>>,
    hidden: Vec<f32>,
    logit_slopes: Vec<f32>,
    hidden_slopes: Vec<f32>,
    /// Slopes of a layer's outputs, and of the outputs of the layer below.
    slopes: Vec<f32>,
    next_slopes: Vec<f32>,
}

impl Mlp {
    /// Returns the network and the layout of its weights.
    pub(crate) fn new(settings: &MlpSettings, shape: Shape) -> Result<(Self, Layout), String> {
        let &MlpSettings { width, layers, value_width } = settings;
        check_size("width", width)?;
        check_size("value_width", value_width)?;
        if !(1..=16).contains(&layers) {
            return Err(format!("layers must be from 1 to 16, found {layers}"));
        }
        let mut layout = Layout::starting_at(0);
        let mut inputs = shape.vertiports * shape.node_features + shape.aircraft_features;
        let layers = (1..=layers)
            .map(|layer| {
                let from = std::mem::replace(&mut inputs, width);
                Linear::new(&mut layout, &format!("trunk.{layer}"), (from, width), BEFORE_RELU)
            })
            .collect();
        let logits = Linear::new(&mut layout, "logits", (width, shape.vertiports), LOGITS);
        let head = ValueHead::new(&mut layout, width, width + 1, value_width);
        Ok((Self { shape, layers, logits, head }, layout))
    }

    pub(crate) fn space(&self, batch: usize) -> MlpSpace {
        let width = self.logits.weight.rows;
        let value_width = self.head.hidden_bias.columns;
        MlpSpace {
            features: vec![0.0; batch * self.layers[0].weight.rows],
            outputs: self.layers.iter().map(|_| vec![0.0; batch * width]).collect(),
            hidden: vec![0.0; batch * value_width],
            logit_slopes: vec![0.0; batch * self.shape.vertiports],
            hidden_slopes: vec![0.0; batch * value_width],
            slopes: vec![0.0; batch * width],
            next_slopes: vec![0.0; batch * width],
        }
    }

    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut MlpSpace,
        outputs: &mut Outputs,
    ) {
        let (batch, width) = (inputs.batch, self.logits.weight.rows);
        self.flatten(inputs, &mut space.features);
        let mut from = &space.features[..batch * self.layers[0].weight.rows];
        for (layer, to) in self.layers.iter().zip(&mut space.outputs) {
            let to = &mut to[..batch * width];
            layer.forward(tensors, from, to);
            relu::forward(to);
            from = to;
        }
        let logits = &mut outputs.logits[..batch * self.shape.vertiports];
        self.logits.forward(tensors, from, logits);
        for (logit, &open) in logits.iter_mut().zip(inputs.mask) {
            *logit = if open == 0 { f32::NEG_INFINITY } else { *logit };
        }
        let value_width = self.head.hidden_bias.columns;
        let hidden = &mut space.hidden[..batch * value_width];
        repeat(tensors.part(self.head.hidden_bias), hidden);
        let from = Matrix::new(from, batch, width);
        let to = MatrixMut::new(hidden, batch, value_width);
        multiply(to, Write::Add, from, tensors.matrix(self.head.features()));
        self.head.forward(tensors, inputs.clock, hidden, &mut outputs.values[..batch]);
    }

    /// Writes the features of all nodes, then those of the aircraft.
    fn flatten(&self, inputs: Inputs<'_>, features: &mut [f32]) {
        let of_nodes = self.shape.vertiports * self.shape.node_features;
        let of_aircraft = self.shape.aircraft_features;
        let from =
            inputs.nodes.chunks_exact(of_nodes).zip(inputs.aircraft.chunks_exact(of_aircraft));
        for (to, (nodes, aircraft)) in features.chunks_exact_mut(of_nodes + of_aircraft).zip(from) {
            let (to_nodes, to_aircraft) = to.split_at_mut(of_nodes);
            to_nodes.copy_from_slice(nodes);
            to_aircraft.copy_from_slice(aircraft);
        }
    }

    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        loss: Slopes<'_>,
        space: &mut MlpSpace,
        gradient: &mut [f32],
    ) {
        let (batch, width) = (inputs.batch, self.logits.weight.rows);
        let value_width = self.head.hidden_bias.columns;
        let hidden_slopes = &mut space.hidden_slopes[..batch * value_width];
        let hidden = &space.hidden[..batch * value_width];
        let last = space.outputs.last().expect("at least one layer");
        let last = &last[..batch * width];
        self.head.backward(tensors, inputs.clock, hidden, loss.values, hidden_slopes, gradient);
        add_rows(hidden_slopes, self.head.hidden_bias.part_mut(gradient));
        add_weight_slopes(self.head.features(), last, hidden_slopes, gradient);
        let slopes = &mut space.slopes[..batch * width];
        let hidden_slopes = Matrix::new(hidden_slopes, batch, value_width);
        let features = tensors.matrix(self.head.features()).transposed();
        multiply(MatrixMut::new(slopes, batch, width), Write::Set, hidden_slopes, features);

        let masked = &mut space.logit_slopes[..batch * self.shape.vertiports];
        for ((masked, slope), &open) in masked.iter_mut().zip(loss.logits).zip(inputs.mask) {
            *masked = if open == 0 { 0.0 } else { *slope };
        }
        self.logits.backward(last, masked, gradient);
        self.logits.input_slopes(tensors, masked, Write::Add, slopes);
        self.layers_backward(tensors, batch, space, gradient);
    }

    /// Goes from the slopes of the last layer's outputs down to the first layer.
    fn layers_backward(
        &self,
        tensors: Tensors<'_>,
        batch: usize,
        space: &mut MlpSpace,
        gradient: &mut [f32],
    ) {
        let len = batch * self.logits.weight.rows;
        let MlpSpace { features, outputs, slopes, next_slopes, .. } = space;
        for at in (0..self.layers.len()).rev() {
            let layer = self.layers[at];
            relu::backward(&outputs[at][..len], &mut slopes[..len]);
            if at == 0 {
                layer.backward(&features[..batch * layer.weight.rows], &slopes[..len], gradient);
                return;
            }
            layer.backward(&outputs[at - 1][..len], &slopes[..len], gradient);
            layer.input_slopes(tensors, &slopes[..len], Write::Set, &mut next_slopes[..len]);
            std::mem::swap(slopes, next_slopes);
        }
    }
}
