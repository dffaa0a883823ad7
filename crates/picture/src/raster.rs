//! Converts an SVG figure to PNG with the embedded font, so that the picture is the same on every
//! machine.

use std::sync::{Arc, LazyLock};

use resvg::{tiny_skia, usvg};

/// Pixels of the PNG for each pixel of the SVG: sharp on dense screens and in print.
const PIXEL_RATIO: f32 = 2.0;

/// The font Inter, reduced to Latin letters; its licence is in `assets/OFL.txt`.
const FONTS: [&[u8]; 2] =
    [include_bytes!("../assets/Inter-Regular.otf"), include_bytes!("../assets/Inter-SemiBold.otf")];

static FONT_DATABASE: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut database = usvg::fontdb::Database::new();
    for font in FONTS {
        database.load_font_data(font.to_vec());
    }
    Arc::new(database)
});

/// The figure as PNG at twice its size.
///
/// # Panics
/// Panics if the SVG is not well-formed or has no size, which does not happen for the figures of
/// this crate.
pub fn png(svg: &str) -> Vec<u8> {
    rendered(svg, PIXEL_RATIO).encode_png().expect("a picture in memory can be encoded")
}

/// The figure in its own size as pixels, row by row from the top, each with red, green and blue
/// from 0 to 255. The ground is opaque.
///
/// # Panics
/// Panics if the SVG is not well-formed or has no size, which does not happen for the pictures of
/// this crate.
pub fn rgb(svg: &str) -> Vec<u8> {
    let pixels = rendered(svg, 1.0);
    pixels.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}

fn rendered(svg: &str, ratio: f32) -> tiny_skia::Pixmap {
    let options = usvg::Options {
        font_family: "Inter".to_owned(),
        fontdb: Arc::clone(&FONT_DATABASE),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(svg, &options).expect("figures are well-formed SVG");
    let size = tree.size().to_int_size().scale_by(ratio).expect("figures have a size");
    let mut pixels =
        tiny_skia::Pixmap::new(size.width(), size.height()).expect("figures have a size");
    let scale = tiny_skia::Transform::from_scale(ratio, ratio);
    resvg::render(&tree, scale, &mut pixels.as_mut());
    pixels
}
