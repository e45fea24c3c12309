//! The ground motion of a case in words.

use crate::codec::{Reader, Writer};
use crate::{CaseError, Ground, GroundPiece, MOST_PIECES, Shape};
use sprag_shared::ground::harmonic::Harmonic;
use sprag_shared::ground::{DampedOscillation, Harmonics, Linear, Ricker};
use sprag_shared::structure::error::require;

/// Numbers of a shape.
const NUMBERS: usize = 9;

pub(super) fn encode(ground: &Ground<'_>, out: &mut Writer<'_>) -> Result<(), CaseError> {
    let vertical = u32::from(ground.is_vertical());
    match ground {
        Ground::Pieces { horizontal, vertical: shapes } => {
            let used = horizontal.iter().rposition(|piece| piece.duration != 0.0).map_or(0, |last| last + 1);
            [0, used as u32, vertical].iter().try_for_each(|&word| out.word(word))?;
            for piece in &horizontal[..used] {
                encode_shape(&piece.shape, Some(piece.duration), out)?;
            }
            let shapes = shapes.as_ref().map_or(&[][..], |shapes| &shapes[..used]);
            shapes.iter().try_for_each(|shape| encode_shape(shape, None, out))
        }
        Ground::Record { interval, samples, vertical: up } => {
            let count = samples.len() as u32;
            let up = up.unwrap_or(&[]);
            if vertical == 1 && up.len() != samples.len() {
                return Err(CaseError::Uneven { horizontal: count, vertical: up.len() as u32 });
            }
            [1, count, vertical].iter().try_for_each(|&word| out.word(word))?;
            out.single(*interval)?;
            samples.iter().chain(up).try_for_each(|&bits| out.word(bits))
        }
    }
}

pub(super) fn decode<'a>(input: &mut Reader<'a>) -> Result<Ground<'a>, CaseError> {
    let recorded = input.kind("ground", &[false, true])?;
    let count = input.word("the length of the ground motion")?;
    let is_vertical = input.kind("vertical motion", &[false, true])?;
    if recorded {
        let interval = input.single("interval")?;
        let samples = input.words(count, "the last sample")?;
        let vertical = if is_vertical { Some(input.words(count, "the last vertical sample")?) } else { None };
        return Ok(Ground::Record { interval, samples, vertical });
    }
    let mut horizontal = [GroundPiece::NONE; MOST_PIECES];
    for piece in horizontal.get_mut(..count as usize).ok_or(CaseError::TooManyPieces(count))? {
        let kind = shape_kind(input)?;
        let duration = input.single("duration")?;
        *piece = GroundPiece { shape: decode_shape(kind, input)?, duration };
    }
    let mut vertical = None;
    if is_vertical {
        let shapes = vertical.insert([Shape::Quiet; MOST_PIECES]);
        for shape in shapes.iter_mut().take(count as usize) {
            let kind = shape_kind(input)?;
            *shape = decode_shape(kind, input)?;
        }
    }
    Ok(Ground::Pieces { horizontal, vertical })
}

fn encode_shape(shape: &Shape, duration: Option<f32>, out: &mut Writer<'_>) -> Result<(), CaseError> {
    let sines = |terms: &[Harmonic<f32>]| {
        let mut numbers = [0.0; NUMBERS];
        for (three, term) in numbers.as_chunks_mut::<3>().0.iter_mut().zip(terms) {
            *three = [term.amplitude, term.frequency, term.phase];
        }
        numbers
    };
    let (kind, numbers) = match shape {
        Shape::Quiet => (0, [0.0; NUMBERS]),
        Shape::Linear(line) => (1, [line.start, line.slope, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        Shape::Sine(sine) => (2, sines(&sine.terms)),
        Shape::ThreeSines(three) => (3, sines(&three.terms)),
        Shape::Damped(free) => (5, [free.real, free.imaginary, free.decay, free.frequency, 0.0, 0.0, 0.0, 0.0, 0.0]),
        Shape::Ricker(r) => (4, [r.amplitude, r.rate, r.centre, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    };
    out.word(kind)?;
    duration.map_or(Ok(()), |duration| out.single(duration))?;
    numbers.iter().try_for_each(|&number| out.single(number))
}

fn shape_kind(input: &mut Reader<'_>) -> Result<u32, CaseError> {
    input.kind("shape", &[0, 1, 2, 3, 4, 5])
}

fn decode_shape(kind: u32, input: &mut Reader<'_>) -> Result<Shape, CaseError> {
    let mut numbers = [0.0; NUMBERS];
    for number in &mut numbers {
        *number = input.single("a number of the shape")?;
        require("number of a shape", f64::from(*number), true, "finite")?;
    }
    let [a, b, c, d, e, f, g, h, i] = numbers;
    let sine = |amplitude, frequency, phase| Harmonic { amplitude, frequency, phase };
    Ok(match kind {
        0 => Shape::Quiet,
        1 => Shape::Linear(Linear { start: a, slope: b }),
        2 => Shape::Sine(Harmonics { terms: [sine(a, b, c)] }),
        3 => Shape::ThreeSines(Harmonics { terms: [sine(a, b, c), sine(d, e, f), sine(g, h, i)] }),
        5 => Shape::Damped(DampedOscillation { real: a, imaginary: b, decay: c, frequency: d }),
        _ => Shape::Ricker(Ricker { amplitude: a, rate: b, centre: c }),
    })
}
