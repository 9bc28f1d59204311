//! A schematic of the rig with the places of the effects, and the sensors beside it.

use maud::{Markup, html};

use crate::report::findings::{Findings, Verdict};
use crate::report::plot::px;
use crate::report::words::{Part, element, part, place};

/// Sensors that have room.
const SENSORS: usize = 9;

/// The parts that are drawn; the rigs differ in them.
struct Drawing {
    upper: &'static str,
    lower: &'static str,
    strut: bool,
    guide: bool,
    tire: bool,
    actuator: bool,
}

impl Drawing {
    /// By the places that the catalogue's candidates have in this rig.
    fn of(findings: &Findings) -> Option<Self> {
        let has = |wanted: Part| {
            let candidates = findings.candidates.iter().map(|candidate| candidate.element.as_str());
            let effects = findings.effects.iter().map(|effect| effect.element.as_str());
            let unmodelled = findings.unmodelled.iter().map(|it| it.place.as_str());
            candidates.chain(effects).chain(unmodelled).any(|element| part(element) == Some(wanted))
        };
        let (strut, tire, actuator) = (has(Part::Strut), has(Part::Tire), has(Part::Actuator));
        let guide = has(Part::Guide);
        if tire {
            Some(Self { upper: "body", lower: "wheel", strut: true, guide: true, tire, actuator: true })
        } else if strut {
            // A mass on a moved base has a guide; what a strut alone is clamped to, nothing says.
            let (upper, lower) = if guide { ("body", "base") } else { ("upper end", "lower end") };
            Some(Self { upper, lower, strut, guide, tire, actuator })
        } else if actuator || guide {
            Some(Self { upper: "carriage", lower: "frame", strut, guide: true, tire, actuator: true })
        } else {
            None
        }
    }
}

/// How a part of the rig is drawn.
#[derive(Clone, Copy, PartialEq)]
enum Mark {
    None,
    /// An effect acts there.
    Found,
    /// An effect acts there or elsewhere.
    Possible,
}

impl Mark {
    fn class(self) -> &'static str {
        match self {
            Self::None => "part",
            Self::Found => "part hot",
            Self::Possible => "part maybe",
        }
    }
}

/// The elements of effects and missing signals; of mismatched parameters if those are the verdict.
fn marked(findings: &Findings) -> Vec<&str> {
    let effects = findings.effects.iter().map(|effect| effect.element.as_str());
    let unmodelled = findings.unmodelled.iter().map(|it| it.place.as_str());
    let wrong = findings
        .nominal_parameters
        .iter()
        .filter(|parameter| findings.verdict == Verdict::ParameterMismatch && parameter.mismatch);
    let owners = wrong.filter_map(|parameter| parameter.name.split('.').next());
    let mut elements = Vec::new();
    for element in effects.chain(unmodelled).chain(owners.filter(|owner| part(owner).is_some())) {
        if !elements.contains(&element) {
            elements.push(element);
        }
    }
    elements
}

/// The schematic, if the findings name parts of the rig.
pub fn figure(findings: &Findings) -> Markup {
    let Some(drawing) = Drawing::of(findings) else {
        return html! {};
    };
    let marked = marked(findings);
    let mark = |wanted: Part| {
        let here = |element: &&str| part(element) == Some(wanted);
        let doubts = || findings.effects.iter().flat_map(|effect| &effect.ambiguous_with);
        match () {
            () if marked.iter().any(here) => Mark::Found,
            () if doubts().any(|key| here(&element(key))) => Mark::Possible,
            () => Mark::None,
        }
    };
    let places: Vec<String> = marked.iter().map(|element| place(element)).collect();
    let alt = if places.is_empty() {
        "The rig".to_owned()
    } else {
        format!("The rig; an effect acts {}", places.join(", "))
    };
    let height = if drawing.tire { 372 } else { 270 };
    html! {
        figure.schematic {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 424 {height}")) role="img" class="plot" {
                title { (alt) }
                @if drawing.guide {
                    g class=(mark(Part::Guide).class()) {
                        (halo(mark(Part::Guide), 8.0, 22.0, 46.0, 238.0))
                        path d="M22 26V256" {}
                        @for y in (34..=254).step_by(11) { path class="thin" d=(format!("M22 {y}l-8 8")) {} }
                        rect class="solid" x="17" y="52" width="10" height="26" {}
                        path d="M27 65H50" {}
                        rect class="solid" x="17" y="216" width="10" height="26" {}
                        path d="M27 229H50" {}
                        text x="8" y="17" { "guide" }
                    }
                }
                (mass(mark(Part::Body), 40.0, drawing.upper))
                @if drawing.strut {
                    g class=(mark(Part::Strut).class()) {
                        (halo(mark(Part::Strut), 36.0, 94.0, 100.0, 106.0))
                        (spring(84.0, 90.0, 204.0))
                        (damper(118.0, 90.0, 204.0))
                        text x="70" y="151" text-anchor="end" { "strut" }
                    }
                }
                @if drawing.actuator {
                    g class=(mark(Part::Actuator).class()) {
                        (halo(mark(Part::Actuator), 152.0, 94.0, 110.0, 106.0))
                        path d="M182 90V128M182 166V204" {}
                        rect class="solid" x="164" y="128" width="36" height="38" rx="3" {}
                        path d="M182 135V159M178 141L182 135L186 141M178 153L182 159L186 153" {}
                        text x="206" y="136" { "actuator" }
                    }
                }
                (mass(mark(Part::Wheel), 204.0, drawing.lower))
                @if drawing.tire {
                    g class=(mark(Part::Tire).class()) {
                        (halo(mark(Part::Tire), 88.0, 257.0, 100.0, 68.0))
                        (spring(110.0, 254.0, 326.0))
                        (damper(146.0, 254.0, 326.0))
                        text x="162" y="294" { "tyre" }
                    }
                    g class=(mark(Part::Road).class()) {
                        (halo(mark(Part::Road), 28.0, 320.0, 206.0, 46.0))
                        path d="M96 326H160" {}
                        path d="M32 342C60 330 78 330 100 338S140 350 165 338S205 330 230 340" {}
                        text x="131" y="361" text-anchor="middle" { "road" }
                    }
                }
                (sensors(findings, &marked))
            }
        }
    }
}

fn halo(mark: Mark, x: f64, y: f64, width: f64, height: f64) -> Markup {
    html! { @if mark != Mark::None { rect class="halo" x=(x) y=(y) width=(width) height=(height) rx="8" {} } }
}

fn mass(mark: Mark, y: f64, label: &str) -> Markup {
    html! {
        g class=(mark.class()) {
            (halo(mark, 44.0, y - 6.0, 178.0, 62.0))
            rect class="solid" x="50" y=(y) width="166" height="50" rx="4" {}
            text x="133" y=(y + 30.0) text-anchor="middle" { (label) }
        }
    }
}

fn spring(x: f64, top: f64, bottom: f64) -> Markup {
    let (first, last) = (top + (bottom - top) * 0.28, bottom - (bottom - top) * 0.16);
    let turns = 8;
    let mut d = format!("M{x} {top}V{}", px(first));
    for turn in 0..turns {
        let y = first + (last - first) * (f64::from(turn) + 0.5) / f64::from(turns);
        d.push_str(&format!("L{} {}", x + if turn % 2 == 0 { 9.0 } else { -9.0 }, px(y)));
    }
    d.push_str(&format!("L{x} {}V{bottom}", px(last)));
    html! { path d=(d) {} }
}

fn damper(x: f64, top: f64, bottom: f64) -> Markup {
    let (cup, piston) = (top + (bottom - top) * 0.36, top + (bottom - top) * 0.55);
    let floor = top + (bottom - top) * 0.72;
    let d = format!(
        "M{x} {top}V{}M{} {}H{}M{} {}V{}H{}V{}M{x} {}V{bottom}",
        px(piston),
        x - 6.0,
        px(piston),
        x + 6.0,
        x - 10.0,
        px(cup),
        px(floor),
        x + 10.0,
        px(cup),
        px(floor)
    );
    html! { path d=(d) {} }
}

/// Where a sensor sits, by its signal's name: a point of the drawing.
fn station(name: &str) -> (f64, f64) {
    let has = |words: &[&str]| words.iter().any(|word| name.contains(word));
    if has(&["tire", "tyre"]) {
        (172.0, 306.0)
    } else if has(&["road", "ground"]) {
        (224.0, 337.0)
    } else if has(&["wheel", "unsprung"]) {
        (208.0, 229.0)
    } else if has(&["suspension", "strut", "deflection", "travel"]) {
        (142.0, 184.0)
    } else if has(&["force", "voltage", "current", "actuator", "motor", "pressure"]) {
        (200.0, 156.0)
    } else {
        (208.0, 65.0)
    }
}

/// The signals with lines to where they are measured; distorted ones in colour.
fn sensors(findings: &Findings, marked: &[&str]) -> Markup {
    let distorted = marked.iter().copied().filter(|element| part(element).is_none());
    let mut names: Vec<&str> = distorted.collect();
    for signal in findings.signals.iter().map(|signal| signal.name.as_str()) {
        if !names.contains(&signal) && names.len() < SENSORS {
            names.push(signal);
        }
    }
    names.truncate(SENSORS);
    names.sort_by(|a, b| station(a).1.total_cmp(&station(b).1));
    // Labels keep a line's distance from each other.
    let levels = names.iter().scan(0.0_f64, |level, name| {
        *level = (*level + 19.0).max(station(name).1);
        Some(*level)
    });
    html! {
        @for (name, level) in names.iter().zip(levels) {
            @let (x, y) = station(name);
            g class=(if marked.contains(name) { "sensor hot" } else { "sensor" }) {
                circle cx=(x) cy=(y) r="4" {}
                path d=(format!("M{} {y}L262 {}H268", x + 4.0, px(level))) {}
                text x="272" y=(px(level + 4.0)) { (shortened(name)) }
            }
        }
    }
}

fn shortened(name: &str) -> String {
    if name.chars().count() <= 22 {
        name.to_owned()
    } else {
        name.chars().take(21).collect::<String>() + "…"
    }
}
