//! GCAPS (§IV, Eq. 18-21, Table 3): a graph-capsule encoder, an attention decoder, and a value
//! head.
//!
//! The paper's encoder on the complete graph has a separate form, which takes a third of the
//! products ([`encoder`]). All other settings of the graph have encoders that follow the equations
//! product by product.

mod capsule_layers;
mod decoder;
mod encoder;
#[cfg(test)]
mod encoder_tests;
mod graph;
#[cfg(test)]
mod graph_tests;
mod products;
pub(crate) mod reads;
mod self_attention;

use capsule_layers::{CapsuleLayers, CapsuleSpace};
use decoder::{Capsules, Decoder, DecoderSpace};
use encoder::{Encoder, EncoderSpace};
use graph::Graph;
use products::{EncoderProducts, Products};
use reads::Reads;
use self_attention::{AttentionSpace, SelfAttention};

use vertifleet_observe::Shape;

use crate::nn::architecture::{EncoderKind, GcapsSettings, check_size};
use crate::nn::batch::{Inputs, Outputs, Slopes};
use crate::nn::init::{self, Init};
use crate::nn::layer_norm::LayerNorm;
use crate::nn::layout::{Layout, Slot, Tensors};
use crate::nn::linear::Linear;
use crate::nn::value_head::ValueHead;

/// The places of the weights of the paper's encoder. Except for `node`, they are used in products
/// only.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EncoderWeights {
    /// W_0, b_0.
    node: Linear,
    /// V_10, V_11, V_12.
    first: [Slot; 3],
    /// V_20, V_21, V_22.
    second: [Slot; 3],
}

/// The places of the weights that enter products of the decoder. Except for `hidden_bias`, they are
/// used in products only.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DecoderWeights {
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
#[derive(Debug, Clone)]
pub(crate) struct Gcaps {
    weights: DecoderWeights,
    products: Products,
    encoder: AnyEncoder,
    decoder: Decoder,
}

/// An encoder, which computes the decoder's input from the features of the vertiports.
#[derive(Debug, Clone)]
enum AnyEncoder {
    OfThePaper(Box<(Encoder, EncoderWeights)>),
    Capsules(CapsuleLayers),
    Transformer(SelfAttention),
}

/// The working memory of an encoder.
#[derive(Debug)]
enum AnySpace {
    OfThePaper(EncoderSpace),
    Capsules(CapsuleSpace),
    Transformer(AttentionSpace),
}

/// The working memory of a pass.
#[derive(Debug)]
pub(crate) struct GcapsSpace {
    encoder: AnySpace,
    decoder: DecoderSpace,
    capsule_slopes: Vec<f32>,
}

impl Gcaps {
    /// Returns the network, the layout of its weights, and the layout of the products behind them.
    /// The layout starts with the weights that are used in products only; their number comes last.
    pub(crate) fn new(
        settings: &GcapsSettings,
        shape: Shape,
    ) -> Result<(Self, Layout, Layout, usize), String> {
        let &GcapsSettings { width, heads, ref graph, charge: _ } = settings;
        check_size("width", width)?;
        check_size("heads", heads)?;
        graph.check()?;
        if !width.is_multiple_of(heads) {
            return Err(format!("width must be a multiple of heads ({heads}), found {width}"));
        }
        let mut layout = Layout::starting_at(0);
        let square = (width, width);
        let plain = Init::Uniform { inputs: width, gain: 1.0 };
        let is_of_the_paper = graph.uses_paper_encoder();
        let hops = is_of_the_paper.then(|| paper_hops(&mut layout, width));
        let capsule = match graph.encoder {
            EncoderKind::Capsules => graph.moments * width,
            EncoderKind::Transformer => width,
        };
        let value_inputs = 2 * width + 1;
        let means = Init::Uniform { inputs: value_inputs, gain: init::BEFORE_RELU };
        let embed = Linear::new(&mut layout, "encoder.feed_forward", (capsule, width), 1.0);
        let key = layout.matrix("decoder.key.weight", square, plain);
        let value = layout.matrix("decoder.value.weight", square, plain);
        let pointer = Init::Uniform { inputs: width, gain: init::LOGITS };
        let pointer = layout.matrix("decoder.pointer.weight", square, pointer);
        let means = layout.matrix("value.means.weight", square, means);
        let folded = layout.len();

        let mut encoder = if let Some([first, second]) = hops {
            let node = Linear::new(&mut layout, "encoder.node", (shape.node_features, width), 1.0);
            Err(EncoderWeights { node, first, second })
        } else {
            Ok(general_encoder(&mut layout, settings, shape))
        };
        let query =
            Linear::new(&mut layout, "decoder.query", (shape.aircraft_features, width), 1.0);
        let output = layout.matrix("decoder.output.weight", square, plain);
        let first_norm = LayerNorm::new(&mut layout, "decoder.norm_1", width);
        let feed_forward =
            Linear::new(&mut layout, "decoder.feed_forward", square, init::BEFORE_RELU);
        let second_norm = LayerNorm::new(&mut layout, "decoder.norm_2", width);
        let head = ValueHead::new(&mut layout, width, value_inputs, width);
        let hidden_bias = head.hidden_bias;
        let weights = DecoderWeights { embed, key, value, pointer, means, hidden_bias };

        let mut behind = Layout::starting_at(layout.end());
        if let Err(of_encoder) = encoder {
            let products = EncoderProducts::new(&mut behind, &of_encoder);
            let node = of_encoder.node;
            let of_the_paper = Encoder { vertiports: shape.vertiports, width, node, products };
            encoder = Ok(AnyEncoder::OfThePaper(Box::new((of_the_paper, of_encoder))));
        }
        let products = Products::new(&mut behind, &weights);
        let reads = Reads {
            vertiports: shape.vertiports,
            heads,
            width: capsule,
            score_scale: 1.0 / ((width / heads) as f32).sqrt(),
            logit_scale: 1.0 / (width as f32).sqrt(),
            attention: graph.attention,
        };
        let decoder =
            Decoder { reads, query, output, first_norm, feed_forward, second_norm, head, products };
        let encoder = encoder.expect("made above");
        Ok((Self { weights, products, encoder, decoder }, layout, behind, folded))
    }

    pub(crate) fn space(&self, batch: usize) -> GcapsSpace {
        let Reads { vertiports, width, .. } = self.decoder.reads;
        GcapsSpace {
            encoder: match &self.encoder {
                AnyEncoder::OfThePaper(paper) => {
                    AnySpace::OfThePaper(EncoderSpace::new(&paper.0, batch))
                }
                AnyEncoder::Capsules(layers) => AnySpace::Capsules(layers.space(batch)),
                AnyEncoder::Transformer(layers) => AnySpace::Transformer(layers.space(batch)),
            },
            decoder: DecoderSpace::new(&self.decoder, batch),
            capsule_slopes: vec![0.0; batch * vertiports * width],
        }
    }

    pub(crate) fn prepare(&self, params: &[f32], derived: &mut [f32]) {
        if let AnyEncoder::OfThePaper(paper) = &self.encoder {
            let (encoder, weights) = &**paper;
            encoder.products.prepare(weights, params, derived);
        }
        self.products.prepare(&self.weights, params, derived);
    }

    pub(crate) fn finish(&self, params: &[f32], gradient: &mut [f32]) {
        if let AnyEncoder::OfThePaper(paper) = &self.encoder {
            let (encoder, weights) = &**paper;
            encoder.products.finish(weights, params, gradient);
        }
        self.products.finish(&self.weights, params, gradient);
    }

    pub(crate) fn forward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut GcapsSpace,
        outputs: &mut Outputs,
    ) {
        self.encoder.forward(tensors, inputs, &mut space.encoder);
        let capsules = self.encoder.read(&space.encoder, inputs.batch);
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
        let values = self.encoder.read(&space.encoder, inputs.batch);
        let capsule_slopes = &mut space.capsule_slopes[..values.len()];
        let given = Capsules { values, slopes: capsule_slopes };
        self.decoder.backward(tensors, inputs, given, slopes, &mut space.decoder, gradient);
        self.encoder.backward(tensors, inputs, &mut space.encoder, capsule_slopes, gradient);
    }
}

/// The weights of the hops of the paper's encoder, which are used in products only.
fn paper_hops(layout: &mut Layout, width: usize) -> [[Slot; 3]; 2] {
    // Three terms add up before each rectifier.
    let hop = Init::Uniform { inputs: 3 * width, gain: init::BEFORE_RELU };
    [1, 2].map(|p| {
        [0, 1, 2].map(|a| {
            layout.matrix(&format!("encoder.moment_{p}.hop_{a}.weight"), (width, width), hop)
        })
    })
}

fn general_encoder(layout: &mut Layout, settings: &GcapsSettings, shape: Shape) -> AnyEncoder {
    let &GcapsSettings { width, heads, ref graph, charge: _ } = settings;
    let Shape { vertiports, node_features, .. } = shape;
    match graph.encoder {
        EncoderKind::Capsules => {
            let (adjacency, laplacian) = (graph.adjacency, graph.laplacian);
            let edges = Graph { nodes: vertiports, node_features, adjacency, laplacian };
            let sizes = (graph.layers, graph.moments, graph.hops);
            AnyEncoder::Capsules(CapsuleLayers::new(layout, "encoder", edges, width, sizes))
        }
        EncoderKind::Transformer => {
            let (inputs, sizes) = ((vertiports, node_features), (width, heads));
            AnyEncoder::Transformer(SelfAttention::new(layout, inputs, sizes, graph.layers))
        }
    }
}

impl AnyEncoder {
    fn forward(&self, tensors: Tensors<'_>, inputs: Inputs<'_>, space: &mut AnySpace) {
        match (self, space) {
            (Self::OfThePaper(paper), AnySpace::OfThePaper(space)) => {
                paper.0.forward(tensors, inputs, space);
            }
            (Self::Capsules(layers), AnySpace::Capsules(space)) => {
                layers.forward(tensors, inputs, space);
            }
            (Self::Transformer(layers), AnySpace::Transformer(space)) => {
                layers.forward(tensors, inputs, space);
            }
            _ => panic!("{OTHER_SPACE}"),
        }
    }

    /// The decoder's input of a batch after a forward pass.
    fn read<'space>(&self, space: &'space AnySpace, batch: usize) -> &'space [f32] {
        match (self, space) {
            (Self::OfThePaper(paper), AnySpace::OfThePaper(space)) => {
                let Encoder { vertiports, width, .. } = paper.0;
                &space.capsules[..batch * vertiports * 2 * width]
            }
            (Self::Capsules(layers), AnySpace::Capsules(space)) => layers.read(space, batch),
            (Self::Transformer(layers), AnySpace::Transformer(space)) => layers.read(space, batch),
            _ => panic!("{OTHER_SPACE}"),
        }
    }

    /// Adds the slopes of the encoder's weights. `slopes` are those of the decoder's input; they
    /// are overwritten.
    fn backward(
        &self,
        tensors: Tensors<'_>,
        inputs: Inputs<'_>,
        space: &mut AnySpace,
        slopes: &mut [f32],
        gradient: &mut [f32],
    ) {
        match (self, space) {
            (Self::OfThePaper(paper), AnySpace::OfThePaper(space)) => {
                paper.0.backward(tensors, inputs, space, slopes, gradient);
            }
            (Self::Capsules(layers), AnySpace::Capsules(space)) => {
                layers.backward(tensors, inputs, space, slopes, gradient);
            }
            (Self::Transformer(layers), AnySpace::Transformer(space)) => {
                layers.backward(tensors, inputs, space, slopes, gradient);
            }
            _ => panic!("{OTHER_SPACE}"),
        }
    }
}

/// A pass received the working memory of another kind of network.
const OTHER_SPACE: &str = "the working memory is of another encoder";
