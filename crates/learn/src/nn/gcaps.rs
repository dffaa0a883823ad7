//! GCAPS (§IV, Eq. 18-21, Table 3): graph-capsule encoder, attention decoder, a value head beside it.

mod decoder;
mod encoder;
mod products;
mod reads;

use decoder::{Decoder, DecoderSpace};
use encoder::{Encoder, EncoderSpace};
use products::Products;
use reads::Reads;

use crate::nn::architecture::{GcapsSettings, Shape, check_size};
use crate::nn::init::{self, Init};
use crate::nn::layer_norm::LayerNorm;
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::Linear;
use crate::nn::network::{Inputs, Outputs};
use crate::nn::product::Write;
use crate::nn::value_head::ValueHead;

/// Where the weights lie that only products of them are worked with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Weights {
    /// W_0, b_0: worked with themselves too.
    node: Linear,
    /// V_10, V_11, V_12.
    first: [Slot; 3],
    /// V_20, V_21, V_22.
    second: [Slot; 3],
}

/// The network's tensors and sizes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Gcaps {
    weights: Weights,
    products: Products,
    encoder: Encoder,
    embed: Linear,
    decoder: Decoder,
}

/// What a pass needs.
#[derive(Debug)]
pub(crate) struct GcapsSpace {
    encoder: EncoderSpace,
    embeddings: Vec<f32>,
    decoder: DecoderSpace,
    embedding_slopes: Vec<f32>,
    capsule_slopes: Vec<f32>,
}

impl Gcaps {
    /// The network, its weights' layout, and that of the products behind them. Weights come in the order of the
    /// layout: first those that only products of them are worked with.
    pub(crate) fn new(settings: &GcapsSettings, shape: Shape) -> Result<(Self, Layout, Layout, usize), String> {
        let &GcapsSettings { width, heads } = settings;
        check_size("width", width)?;
        check_size("heads", heads)?;
        if !width.is_multiple_of(heads) {
            return Err(format!("width must be a multiple of heads ({heads}), found {width}"));
        }
        let mut layout = Layout::starting_at(0);
        let square = (width, width);
        let plain = |inputs| Init::Uniform { inputs, gain: 1.0 };
        // Three terms add up in front of each rectifier.
        let hop = Init::Uniform { inputs: 3 * width, gain: init::BEFORE_RELU };
        let mut hops = |p: usize| {
            [0, 1, 2].map(|a| layout.matrix(&format!("encoder.moment_{p}.hop_{a}.weight"), square, hop))
        };
        let (first, second) = (hops(1), hops(2));
        let folded = layout.len();
        let node = Linear::new(&mut layout, "encoder.node", (shape.node_features, width), 1.0);
        let embed = Linear::new(&mut layout, "encoder.feed_forward", (2 * width, width), 1.0);
        let query = Linear::new(&mut layout, "decoder.query", (shape.aircraft_features, width), 1.0);
        let pointer = Init::Uniform { inputs: width, gain: init::LOGITS };
        let value_inputs = 2 * width + 1;
        let means = Init::Uniform { inputs: value_inputs, gain: init::BEFORE_RELU };
        let decoder = Decoder {
            reads: Reads {
                vertiports: shape.vertiports,
                heads,
                width,
                score_scale: 1.0 / ((width / heads) as f32).sqrt(),
                logit_scale: 1.0 / (width as f32).sqrt(),
            },
            query,
            key: layout.matrix("decoder.key.weight", square, plain(width)),
            value: layout.matrix("decoder.value.weight", square, plain(width)),
            output: layout.matrix("decoder.output.weight", square, plain(width)),
            first_norm: LayerNorm::new(&mut layout, "decoder.norm_1", width),
            feed_forward: Linear::new(&mut layout, "decoder.feed_forward", square, init::BEFORE_RELU),
            second_norm: LayerNorm::new(&mut layout, "decoder.norm_2", width),
            pointer: layout.matrix("decoder.pointer.weight", square, pointer),
            means: layout.matrix("value.means.weight", square, means),
            head: ValueHead::new(&mut layout, width, value_inputs, width),
        };
        let weights = Weights { node, first, second };
        let mut behind = Layout::starting_at(layout.end());
        let products = Products::new(&mut behind, &weights);
        let encoder = Encoder { vertiports: shape.vertiports, width, node };
        Ok((Self { weights, products, encoder, embed, decoder }, layout, behind, folded))
    }

    pub(crate) fn space(&self, batch: usize) -> GcapsSpace {
        let nodes = batch * self.encoder.vertiports;
        GcapsSpace {
            encoder: EncoderSpace::new(self.encoder, batch),
            embeddings: vec![0.0; nodes * self.encoder.width],
            decoder: DecoderSpace::new(&self.decoder, batch),
            embedding_slopes: vec![0.0; nodes * self.encoder.width],
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
        let nodes = inputs.batch * self.encoder.vertiports;
        self.encoder.forward(tensors, &self.products, inputs, &mut space.encoder);
        let capsules = &space.encoder.capsules[..nodes * 2 * self.encoder.width];
        let embeddings = &mut space.embeddings[..nodes * self.encoder.width];
        self.embed.forward(tensors, capsules, embeddings);
        self.decoder.forward(tensors, inputs, embeddings, &mut space.decoder, outputs);
    }

    pub(crate) fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        slopes: (&[f32], &[f32]),
        space: &mut GcapsSpace,
        gradient: &mut [f32],
    ) {
        let nodes = inputs.batch * self.encoder.vertiports;
        let embeddings = &space.embeddings[..nodes * self.encoder.width];
        let embedding_slopes = &mut space.embedding_slopes[..nodes * self.encoder.width];
        let to = (&mut *embedding_slopes, &mut *gradient);
        self.decoder.backward(tensors, inputs, embeddings, slopes, &mut space.decoder, to);
        let capsule_slopes = &mut space.capsule_slopes[..nodes * 2 * self.encoder.width];
        let capsules = &space.encoder.capsules[..nodes * 2 * self.encoder.width];
        self.embed.backward(capsules, embedding_slopes, gradient);
        self.embed.input_slopes(tensors, embedding_slopes, Write::Set, capsule_slopes);
        let to = (capsule_slopes, gradient);
        self.encoder.backward(tensors, &self.products, inputs, &mut space.encoder, to);
    }
}
