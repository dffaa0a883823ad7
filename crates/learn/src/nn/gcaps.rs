//! GCAPS (§IV, Eq. 18-21, Table 3): a graph-capsule encoder, an attention decoder, and a value head beside it.

mod decoder;
mod encoder;
#[cfg(test)]
mod encoder_tests;
mod products;
pub(crate) mod reads;

use decoder::{Capsules, Decoder, DecoderSpace};
use encoder::{Encoder, EncoderSpace};
use products::Products;
use reads::Reads;

use crate::nn::architecture::{GcapsSettings, Shape, check_size};
use crate::nn::batch::{Inputs, Outputs, Slopes};
use crate::nn::init::{self, Init};
use crate::nn::layer_norm::LayerNorm;
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::Linear;
use crate::nn::value_head::ValueHead;

/// The places of the weights that enter products. Except for `node` and `hidden_bias`, they are used in products only.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// W_0, b_0.
    node: Linear,
    /// V_10, V_11, V_12.
    first: [Slot; 3],
    /// V_20, V_21, V_22.
    second: [Slot; 3],
    /// W_f, b_f: from capsules to embeddings.
    embed: Linear,
    /// W_K, W_V, W_L.
    key: Slot,
    value: Slot,
    pointer: Slot,
    /// The value head's rows for the mean of the embeddings, and the bias of its hidden layer.
    means: Slot,
    hidden_bias: Slot,
}

/// The network's tensors and sizes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gcaps {
    weights: Weights,
    products: Products,
    encoder: Encoder,
    decoder: Decoder,
}

/// The working memory of a pass.
#[derive(Debug)]
pub(crate) struct GcapsSpace {
    encoder: EncoderSpace,
    decoder: DecoderSpace,
    capsule_slopes: Vec<f32>,
}

impl Gcaps {
    /// Returns the network, the layout of its weights, and the layout of the products behind them. The layout starts
    /// with the weights that are used in products only.
    pub(crate) fn new(
        settings: &GcapsSettings,
        shape: Shape,
    ) -> Result<(Self, Layout, Layout, usize), String> {
        let &GcapsSettings { width, heads } = settings;
        check_size("width", width)?;
        check_size("heads", heads)?;
        if !width.is_multiple_of(heads) {
            return Err(format!("width must be a multiple of heads ({heads}), found {width}"));
        }
        let mut layout = Layout::starting_at(0);
        let square = (width, width);
        let plain = Init::Uniform { inputs: width, gain: 1.0 };
        // Three terms add up before each rectifier.
        let hop = Init::Uniform { inputs: 3 * width, gain: init::BEFORE_RELU };
        let mut hops = |p: usize| {
            [0, 1, 2]
                .map(|a| layout.matrix(&format!("encoder.moment_{p}.hop_{a}.weight"), square, hop))
        };
        let (first, second) = (hops(1), hops(2));
        let value_inputs = 2 * width + 1;
        let means = Init::Uniform { inputs: value_inputs, gain: init::BEFORE_RELU };
        let embed = Linear::new(&mut layout, "encoder.feed_forward", (2 * width, width), 1.0);
        let key = layout.matrix("decoder.key.weight", square, plain);
        let value = layout.matrix("decoder.value.weight", square, plain);
        let pointer = Init::Uniform { inputs: width, gain: init::LOGITS };
        let pointer = layout.matrix("decoder.pointer.weight", square, pointer);
        let means = layout.matrix("value.means.weight", square, means);
        let folded = layout.len();

        let node = Linear::new(&mut layout, "encoder.node", (shape.node_features, width), 1.0);
        let query =
            Linear::new(&mut layout, "decoder.query", (shape.aircraft_features, width), 1.0);
        let output = layout.matrix("decoder.output.weight", square, plain);
        let first_norm = LayerNorm::new(&mut layout, "decoder.norm_1", width);
        let feed_forward =
            Linear::new(&mut layout, "decoder.feed_forward", square, init::BEFORE_RELU);
        let second_norm = LayerNorm::new(&mut layout, "decoder.norm_2", width);
        let head = ValueHead::new(&mut layout, width, value_inputs, width);
        let hidden_bias = head.hidden_bias;
        let weights =
            Weights { node, first, second, embed, key, value, pointer, means, hidden_bias };

        let mut behind = Layout::starting_at(layout.end());
        let products = Products::new(&mut behind, &weights);
        let reads = Reads {
            vertiports: shape.vertiports,
            heads,
            width: 2 * width,
            score_scale: 1.0 / ((width / heads) as f32).sqrt(),
            logit_scale: 1.0 / (width as f32).sqrt(),
        };
        let encoder = Encoder { vertiports: shape.vertiports, width, node, products };
        let decoder =
            Decoder { reads, query, output, first_norm, feed_forward, second_norm, head, products };
        Ok((Self { weights, products, encoder, decoder }, layout, behind, folded))
    }

    pub(crate) fn space(&self, batch: usize) -> GcapsSpace {
        let nodes = batch * self.encoder.vertiports;
        GcapsSpace {
            encoder: EncoderSpace::new(&self.encoder, batch),
            decoder: DecoderSpace::new(&self.decoder, batch),
            capsule_slopes: vec![0.0; nodes * 2 * self.encoder.width],
        }
    }

    pub(crate) fn prepare(&self, params: &[f32], derived: &mut [f32]) {
        self.products.prepare(&self.weights, params, derived);
    }

    pub(crate) fn finish(&self, params: &[f32], gradient: &mut [f32]) {
        self.products.finish(&self.weights, params, gradient);
    }

    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut GcapsSpace,
        outputs: &mut Outputs,
    ) {
        let capsules = inputs.batch * self.decoder.reads.vertiports * self.decoder.reads.width;
        self.encoder.forward(tensors, inputs, &mut space.encoder);
        let capsules = &space.encoder.capsules[..capsules];
        self.decoder.forward(tensors, inputs, capsules, &mut space.decoder, outputs);
    }

    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        slopes: Slopes<'_>,
        space: &mut GcapsSpace,
        gradient: &mut [f32],
    ) {
        let capsules = inputs.batch * self.decoder.reads.vertiports * self.decoder.reads.width;
        let capsule_slopes = &mut space.capsule_slopes[..capsules];
        let capsules = &space.encoder.capsules[..capsules];
        let given = Capsules { values: capsules, slopes: capsule_slopes };
        self.decoder.backward(tensors, inputs, given, slopes, &mut space.decoder, gradient);
        self.encoder.backward(tensors, inputs, &mut space.encoder, capsule_slopes, gradient);
    }
}
