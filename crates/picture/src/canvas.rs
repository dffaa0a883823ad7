//! The canvas of a figure: the few shapes that figures need, written as SVG, one element per line.

use std::fmt::Write as _;

use crate::palette::Paint;

/// Font families in order of preference: the embedded font of the PNGs, then common system fonts.
const FONTS: &str = "Inter, 'Segoe UI', Roboto, 'Helvetica Neue', 'Noto Sans', 'Liberation Sans', Arial, sans-serif";

/// Mean width of a letter of that font, as a share of its size; only used to leave enough room.
const LETTER_WIDTH: f64 = 0.56;

/// Position in pixels, right and down from the upper left corner.
pub type Point = (f64, f64);

/// The alignment of a text relative to its position.
#[derive(Debug, Clone, Copy)]
pub enum Anchor {
    /// It begins at the position.
    Start,
    /// It is centred on the position.
    Middle,
    /// It ends at the position.
    End,
}

/// Size, weight, colour and alignment of a text.
#[derive(Debug, Clone, Copy)]
pub struct Lettering {
    /// Size of the letters in pixels.
    pub size: f64,
    /// Whether they are bold.
    pub bold: bool,
    /// Their colour.
    pub paint: Paint,
    /// Alignment.
    pub anchor: Anchor,
}

impl Lettering {
    /// Labels of scales and keys.
    pub const SMALL: Self =
        Self { size: 12.0, bold: false, paint: Paint::Muted, anchor: Anchor::Start };
    /// Names and values.
    pub const LABEL: Self =
        Self { size: 13.0, bold: false, paint: Paint::Ink, anchor: Anchor::Start };

    /// The same with another alignment.
    #[must_use]
    pub fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }

    /// The same in bold.
    #[must_use]
    pub const fn bold(self) -> Self {
        Self { bold: true, ..self }
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    /// Colour.
    pub paint: Paint,
    /// Width in pixels.
    pub width: f64,
    /// Dash pattern in the notation of SVG; `None` for a solid line.
    pub dash: Option<&'static str>,
}

impl Stroke {
    /// A solid line.
    pub fn solid(paint: Paint, width: f64) -> Self {
        Self { paint, width, dash: None }
    }
}

/// The fill and the outline of a shape.
#[derive(Debug, Clone, Copy, Default)]
pub struct Look {
    /// The paint and its opacity.
    pub fill: Option<(Paint, f64)>,
    /// The outline.
    pub stroke: Option<Stroke>,
}

impl Look {
    /// A fill without an outline.
    pub fn filled(paint: Paint) -> Self {
        Self { fill: Some((paint, 1.0)), stroke: None }
    }

    /// An outline without a fill.
    pub fn outlined(stroke: Stroke) -> Self {
        Self { fill: None, stroke: Some(stroke) }
    }
}

/// An SVG picture under construction.
#[derive(Debug)]
pub struct Canvas {
    width: f64,
    height: f64,
    title: String,
    body: String,
}

impl Canvas {
    /// An empty picture with a title in its upper left corner and a subtitle in smaller letters
    /// below it.
    pub fn new(width: f64, height: f64, title: &str, subtitle: &str) -> Self {
        let mut canvas = Self::bare(width, height, title);
        let heading = Lettering { size: 17.0, ..Lettering::LABEL.bold() };
        canvas.text((16.0, 28.0), heading, title);
        canvas.text((16.0, 48.0), Lettering { size: 13.0, ..Lettering::SMALL }, subtitle);
        canvas
    }

    /// An empty picture without a heading; the title is for those who have it read out.
    pub fn bare(width: f64, height: f64, title: &str) -> Self {
        let mut canvas = Self { width, height, title: title.to_owned(), body: String::new() };
        canvas.rectangle((0.0, 0.0), (width, height), Look::filled(Paint::Ground));
        canvas
    }

    /// A straight line.
    pub fn line(&mut self, from: Point, to: Point, stroke: Stroke) {
        let ends = format!(
            "x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"",
            pixels(from.0),
            pixels(from.1),
            pixels(to.0),
            pixels(to.1)
        );
        self.shape("line", &ends, Look::outlined(stroke));
    }

    /// A rectangle with its upper left corner at `corner`.
    pub fn rectangle(&mut self, corner: Point, size: (f64, f64), look: Look) {
        let place = format!(
            "x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
            pixels(corner.0),
            pixels(corner.1),
            pixels(size.0),
            pixels(size.1)
        );
        self.shape("rect", &place, look);
    }

    /// A circle.
    pub fn circle(&mut self, centre: Point, radius: f64, look: Look) {
        let place = format!(
            "cx=\"{}\" cy=\"{}\" r=\"{}\"",
            pixels(centre.0),
            pixels(centre.1),
            pixels(radius)
        );
        self.shape("circle", &place, look);
    }

    /// A line through points, closed or open.
    pub fn polyline(&mut self, points: &[Point], closed: bool, look: Look) {
        let mut path = String::new();
        for (position, point) in points.iter().enumerate() {
            let command = if position == 0 { 'M' } else { 'L' };
            let _ = write!(path, "{command}{} {}", pixels(point.0), pixels(point.1));
        }
        if closed {
            path.push('Z');
        }
        self.path(&path, look);
    }

    /// A path in the notation of SVG.
    pub fn path(&mut self, path: &str, look: Look) {
        self.shape("path", &format!("d=\"{path}\""), look);
    }

    /// The marker of a series: a circle, square, triangle, diamond or inverted triangle.
    pub fn marker(&mut self, at: Point, series: usize) {
        let (x, y) = at;
        let ring = Stroke::solid(Paint::Ground, 1.2);
        let look = Look { fill: Some((Paint::Series(series), 1.0)), stroke: Some(ring) };
        match series % 5 {
            0 => self.circle(at, 4.2, look),
            1 => self.rectangle((x - 3.8, y - 3.8), (7.6, 7.6), look),
            2 => self.polyline(&[(x, y - 5.2), (x + 4.8, y + 3.6), (x - 4.8, y + 3.6)], true, look),
            3 => self.diamond(at, 5.2, look),
            _ => self.polyline(&[(x, y + 5.2), (x + 4.8, y - 3.6), (x - 4.8, y - 3.6)], true, look),
        }
    }

    /// A square that stands on one corner.
    pub fn diamond(&mut self, (x, y): Point, radius: f64, look: Look) {
        let corners = [(x, y - radius), (x + radius, y), (x, y + radius), (x - radius, y)];
        self.polyline(&corners, true, look);
    }

    /// A text whose baseline begins at, is centred on or ends at a position.
    pub fn text(&mut self, at: Point, lettering: Lettering, content: &str) {
        self.text_with(at, lettering, content, "");
    }

    /// Like [`text`](Self::text), with a rim in the colour of the ground, so that it can be read on
    /// top of lines.
    pub fn text_on_lines(&mut self, at: Point, lettering: Lettering, content: &str) {
        let (class, colour) = (Paint::Ground.class(), Paint::Ground.colour());
        let rim = format!(
            " stroke-{class}\" stroke=\"{colour}\" stroke-width=\"3\" paint-order=\"stroke"
        );
        self.text_with(at, lettering, content, &rim);
    }

    /// `rim` continues the list of classes, and may add attributes.
    fn text_with(&mut self, at: Point, lettering: Lettering, content: &str, rim: &str) {
        let anchor = match lettering.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let weight = if lettering.bold { " font-weight=\"600\"" } else { "" };
        let _ = writeln!(
            self.body,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\"{weight}{anchor} class=\"fill-{}{rim}\" fill=\"{}\">{}</text>",
            pixels(at.0),
            pixels(at.1),
            pixels(lettering.size),
            lettering.paint.class(),
            lettering.paint.colour(),
            escaped(content)
        );
    }

    fn shape(&mut self, element: &str, place: &str, look: Look) {
        let mut classes = Vec::new();
        let mut attributes = String::new();
        match look.fill {
            None => attributes.push_str(" fill=\"none\""),
            Some((paint, opacity)) => {
                classes.push(format!("fill-{}", paint.class()));
                let _ = write!(attributes, " fill=\"{}\"", paint.colour());
                if opacity < 1.0 {
                    let _ = write!(attributes, " fill-opacity=\"{opacity}\"");
                }
            }
        }
        if let Some(stroke) = look.stroke {
            classes.push(format!("stroke-{}", stroke.paint.class()));
            let (colour, width) = (stroke.paint.colour(), pixels(stroke.width));
            let _ = write!(attributes, " stroke=\"{colour}\" stroke-width=\"{width}\"");
            if let Some(dash) = stroke.dash {
                let _ = write!(attributes, " stroke-dasharray=\"{dash}\"");
            }
        }
        let _ =
            writeln!(self.body, "<{element} {place} class=\"{}\"{attributes}/>", classes.join(" "));
    }

    /// The picture as a complete SVG document.
    pub fn into_svg(self) -> String {
        let Self { width, height, title, body } = self;
        let (width, height, title) = (pixels(width), pixels(height), escaped(&title));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\" role=\"img\" aria-label=\"{title}\" font-family=\"{FONTS}\" stroke-linejoin=\"round\">\n\
             {body}</svg>\n"
        )
    }
}

/// An estimate of the width of a text, which is rather too large than too small.
pub fn text_width(content: &str, size: f64) -> f64 {
    content.chars().count() as f64 * size * LETTER_WIDTH
}

/// The text, cut and marked with an ellipsis if it is longer than `letters`.
pub fn shortened(content: &str, letters: usize) -> String {
    if content.chars().count() <= letters {
        return content.to_owned();
    }
    content.chars().take(letters.saturating_sub(1)).chain(['…']).collect()
}

/// A length to a tenth of a pixel, without a trailing zero.
pub fn pixels(length: f64) -> String {
    let text = format!("{length:.1}");
    match text.strip_suffix(".0") {
        Some("-0") => "0".to_owned(),
        Some(whole) => whole.to_owned(),
        None => text,
    }
}

/// The text with the characters escaped that have a meaning in XML; characters that XML does not
/// allow become a replacement mark.
fn escaped(content: &str) -> String {
    let mut text = String::with_capacity(content.len());
    for letter in content.chars() {
        match letter {
            '&' => text.push_str("&amp;"),
            '<' => text.push_str("&lt;"),
            '>' => text.push_str("&gt;"),
            '"' => text.push_str("&quot;"),
            '\u{fffe}' | '\u{ffff}' => text.push('\u{fffd}'),
            letter if letter.is_control() => text.push('\u{fffd}'),
            letter => text.push(letter),
        }
    }
    text
}
