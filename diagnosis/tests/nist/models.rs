//! The models of the data sets, as NIST prints them.

use std::f64::consts::{PI, TAU};

use num_dual::DualNum;

/// What the model of the set `name` expects at `x` with the parameters `b`.
///
/// # Panics
/// If there is no such set.
pub fn model<D: DualNum<Primitive = f64> + Copy>(name: &str, b: &[D], x: &[f64]) -> D {
    let one = D::one();
    let at = x[0];
    let decay = |rate: D| (-rate * at).exp();
    // Both polynomials begin with the constant one.
    let polynomial = |coefficients: &[D]| coefficients.iter().rev().fold(D::zero(), |sum, c| sum * at + *c);
    match name {
        "Misra1a" | "BoxBOD" => b[0] * (one - decay(b[1])),
        "Misra1b" => b[0] * (one - (b[1] * at * 0.5 + 1.0).powi(-2)),
        "Misra1c" => b[0] * (one - (b[1] * at * 2.0 + 1.0).powf(-0.5)),
        "Misra1d" => b[0] * b[1] * at / (b[1] * at + 1.0),
        "Chwirut1" | "Chwirut2" => decay(b[0]) / (b[1] + b[2] * at),
        "Lanczos1" | "Lanczos2" | "Lanczos3" => b[0] * decay(b[1]) + b[2] * decay(b[3]) + b[4] * decay(b[5]),
        "Gauss1" | "Gauss2" | "Gauss3" => {
            let peak = |size: D, centre: D, width: D| size * (-((-centre + at) / width).powi(2)).exp();
            b[0] * decay(b[1]) + peak(b[2], b[3], b[4]) + peak(b[5], b[6], b[7])
        }
        "DanWood" => b[0] * (b[1] * at.ln()).exp(),
        "Kirby2" => polynomial(&b[..3]) / polynomial(&[one, b[3], b[4]]),
        "Hahn1" | "Thurber" => polynomial(&b[..4]) / polynomial(&[one, b[4], b[5], b[6]]),
        // For the logarithm of the response.
        "Nelson" => b[0] - b[1] * x[0] * (-b[2] * x[1]).exp(),
        "MGH17" => b[0] + b[1] * decay(b[3]) + b[2] * decay(b[4]),
        "Roszman1" => b[0] - b[1] * at - (b[2] / (-b[3] + at)).atan() / PI,
        "ENSO" => {
            let wave = |period: D, cosine: D, sine: D| {
                let phase = period.recip() * (TAU * at);
                cosine * phase.cos() + sine * phase.sin()
            };
            b[0] + wave(D::from(12.0), b[1], b[2]) + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8])
        }
        "MGH09" => b[0] * (b[1] * at + at * at) / (b[2] * at + b[3] + at * at),
        "Rat42" => b[0] / ((b[1] - b[2] * at).exp() + 1.0),
        "MGH10" => b[0] * (b[1] / (b[2] + at)).exp(),
        "Eckerle4" => b[0] / b[1] * (-((-b[2] + at) / b[1]).powi(2) * 0.5).exp(),
        "Rat43" => b[0] * (-((b[1] - b[2] * at).exp() + 1.0).ln() / b[3]).exp(),
        "Bennett5" => b[0] * (-(b[1] + at).ln() / b[2]).exp(),
        _ => panic!("NIST has no set `{name}`"),
    }
}
