//! Checks encoders on graphs other than the paper's against finite differences, whole networks at a
//! time.

use crate::nn::slope_tests::check_network;
use crate::nn::{Adjacency, Architecture, EncoderKind, GcapsSettings, GraphSettings, Laplacian};

fn check(graph: GraphSettings) {
    for seed in [40, 50] {
        let settings = GcapsSettings { graph, ..GcapsSettings::of_sizes(16, 4) };
        // Smaller weights than usual bend the loss less, so that finite differences are more
        // accurate.
        check_network(Architecture::Gcaps(settings), seed, 0.3);
    }
}

#[test]
fn capsules_of_two_layers_on_routes_that_can_be_flown() {
    check(GraphSettings { layers: 2, adjacency: Adjacency::Reachable, ..GraphSettings::default() });
}

#[test]
fn three_moments_and_three_hops_with_a_normalised_laplacian() {
    check(GraphSettings {
        moments: 3,
        hops: 3,
        laplacian: Laplacian::Normalised,
        adjacency: Adjacency::Profit,
        ..GraphSettings::default()
    });
}

#[test]
fn similar_vertiports_as_neighbours() {
    check(GraphSettings { adjacency: Adjacency::Similarity, ..GraphSettings::default() });
}

#[test]
fn no_graph_and_no_attention() {
    check(GraphSettings { hops: 0, attention: false, ..GraphSettings::default() });
}

#[test]
fn no_attention_with_the_encoder_of_the_paper() {
    check(GraphSettings { attention: false, ..GraphSettings::default() });
}

#[test]
fn self_attention_in_two_layers() {
    check(GraphSettings {
        encoder: EncoderKind::Transformer,
        layers: 2,
        ..GraphSettings::default()
    });
}
