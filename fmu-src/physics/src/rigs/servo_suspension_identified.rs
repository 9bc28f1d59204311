//! The rig of AGH Kraków as it was identified: a linear model of six states, one of them a power.

use std::path::Path;

use strut_model::{
    About, Equation, Experiment, Instant, Kind, Method, Model, NoSettings, Real, Stimulus, Variables, bundles,
};

use crate::signals::{Acceleration, Motion};

/// Konieczny eq. 3.2, 4.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoSuspensionIdentified;

/// Rows 2, 4, 5 and 6 of A; rows 1 and 3 are the velocities.
const A: [[f64; 6]; 4] = [
    [-231.0, -46.0, 23.0, 40.0, 2504.0, -401_800.0],
    [305.0, 50.0, -1248.0, -77.0, -3493.0, 596_600.0],
    [2.0, -1.0, -6.0, 1.0, -53.0, 10_220.0],
    [0.0, 0.0, 0.0, 0.0, 0.0, -1.0],
];

/// The same rows of B, for voltage and road.
const B: [[f64; 2]; 4] = [[4442.0, 212.0], [-6879.0, 949.0], [47.0, 4.0], [0.0, 0.0]];

/// The units that the document's numbers are in.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Parameters<R> {
    /// Unit of the document's displacements: a millimetre (derived, see the notes)
    #[var(unit = M, start = 1e-3, min = 1e-9)]
    pub length_unit: R,
    /// Unit of the document's pressure difference: a bar (derived, see the notes)
    #[var(unit = PA, start = 1e5, min = 1e-3)]
    pub pressure_unit: R,
    /// Unit of the document's power: that of a bar and a cubic metre per second (assumed)
    #[var(unit = W, start = 1e5, min = 1e-3)]
    pub power_unit: R,
}

/// What comes from outside.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Input<R> {
    /// Control voltage of the valve (v)
    #[var(unit = V)]
    pub voltage: R,
    /// Road
    pub road: Height<R>,
}

/// The road, whose velocity is not needed.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Height<R> {
    /// Height (w)
    #[var(unit = M)]
    pub position: R,
}

/// The six states.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// Body
    pub body: Motion<R>,
    /// Wheel
    pub wheel: Motion<R>,
    /// Pressure difference of the chambers (P_r)
    #[var(unit = PA, nominal = 1e5, output)]
    pub pressure: R,
    /// Supply
    pub supply: Supply<R>,
}

/// The unit that supplies the actuator.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Supply<R> {
    /// Power that the actuator takes from the supply (P_z Q_z)
    #[var(unit = W, nominal = 100.0, output)]
    pub power: R,
}

/// What can be measured.
#[derive(Variables, Clone, Copy, Debug, PartialEq)]
pub struct Output<R> {
    /// Body
    pub body: Acceleration<R>,
}

impl Model for ServoSuspensionIdentified {
    const ABOUT: About = About {
        name: "ServoSuspensionIdentified",
        summary: "The AGH rig with its servohydraulic actuator as identified from measurements: six linear \
            states",
        kind: Kind::Rig,
        equations: &[
            Equation {
                text: "x' = A x + B (v, w), x = (z_2, z_2', z_1, z_1', P_r, P_z Q_z)",
                source: "Konieczny eq. 3.2, 4.1",
            },
            Equation {
                text: "z_2'' = -231 z_2 - 46 z_2' + 23 z_1 + 40 z_1' + 2504 P_r - 401800 P_z Q_z + 4442 v + 212 w",
                source: "Konieczny eq. 3.2, row 2",
            },
            Equation {
                text: "z_1'' = 305 z_2 + 50 z_2' - 1248 z_1 - 77 z_1' - 3493 P_r + 596600 P_z Q_z - 6879 v + 949 w",
                source: "Konieczny eq. 3.2, row 4",
            },
            Equation {
                text: "P_r' = 2 z_2 - z_2' - 6 z_1 + z_1' - 53 P_r + 10220 P_z Q_z + 47 v + 4 w",
                source: "Konieczny eq. 3.2, row 5",
            },
            Equation { text: "(P_z Q_z)' = -P_z Q_z", source: "Konieczny eq. 3.2, row 6" },
        ],
        notes: &[
            "Eigenvalues, natural frequencies, damping ratios and the characteristic polynomial are those of \
             eq. 4.2-4.4 to the printed digits, but for lambda_2: -1.4385, printed -1.439 (its 0.22894 Hz is \
             right).",
            "Row 6: no input and no other state acts on the power, which falls from its start value within \
             seconds and stays zero if it starts there. The regression found no law for it, only that it \
             decays; the eigenvalue -1 is this row, and that of a state that cannot be controlled. Column 6 \
             says how a measured power would act. So this model does not tell what power the actuator takes, \
             though the document says so; supply.power of ServoSuspension does.",
            "The document gives no units. Displacements are in millimetres: in metres, 1 V at 1 Hz would move \
             the body by 11.9 m. In millimetres the answers to 1 V are 47 mm at 0.1 Hz, 12 mm at 1 Hz and 3.2 \
             mm at 3.5 Hz, beside 54, 6.2 and 5.0 mm of ServoSuspension. Road and displacements have the same \
             unit, so the answers to the road are those printed in any case.",
            "The pressure is taken to be in bar: at 0.1, 1, 5 and 20 Hz the answer to 1 V is then 0.27, 0.074, \
             0.043 and 0.039 MPa, beside 0.60, 0.065, 0.090 and 0.070 MPa of ServoSuspension (in MPa it would \
             be ten times more). No unit makes its coefficients physical: A_a P_r/m_2 = 2504 P_r asks for a \
             unit of 0.28 MPa, A_a P_r/m_1 = 3493 P_r for 0.05 MPa, alpha A_a = 1 in row 5 for 34 MPa. It is a \
             regression on signals that go together, not a balance of forces.",
            "A lasting rise of the road by 1 lifts body and wheel by 1.011 and 1.009, and leaves no pressure; \
             1 exactly is what equilibrium asks for.",
            "Konieczny eq. 4.4 speaks of the angle of the eigenvector; it is that of the eigenvalue.",
        ],
        experiment: Experiment {
            stop: 4.0,
            step: 1e-3,
            tolerance: 1e-6,
            stimuli: &[("road.position", Stimulus::Step { at: 0.5, height: 0.1 })],
            plot: &["body.position", "wheel.position", "body.acceleration", "pressure"],
        },
        method: Method::Explicit,
    };

    bundles! { parameters: Parameters, input: Input, state: State, output: Output }

    fn prepare(_: &NoSettings, _: Option<&Path>) -> Result<Self, String> {
        Ok(Self)
    }

    #[inline(always)]
    fn equations<R: Real>(&self, now: Instant<'_, Self, R>) -> (State<R>, Output<R>) {
        let (State { body, wheel, pressure, supply }, p) = (*now.state, now.parameters);
        let one = R::from(1.0);
        let (per_length, per_pressure, per_power) =
            (one / p.length_unit, one / p.pressure_unit, one / p.power_unit);
        let motion = |motion: Motion<R>| [motion.position * per_length, motion.velocity * per_length];
        let ([z2, v2], [z1, v1]) = (motion(body), motion(wheel));
        let x = [z2, v2, z1, v1, pressure * per_pressure, supply.power * per_power];
        let u = [now.input.voltage, now.input.road.position * per_length];
        let row = |i: usize| {
            let by_state = (1..6).fold(x[0] * A[i][0], |sum, j| sum + x[j] * A[i][j]);
            by_state + u[0] * B[i][0] + u[1] * B[i][1]
        };
        let rates = State {
            body: Motion { position: body.velocity, velocity: row(0) * p.length_unit },
            wheel: Motion { position: wheel.velocity, velocity: row(1) * p.length_unit },
            pressure: row(2) * p.pressure_unit,
            supply: Supply { power: row(3) * p.power_unit },
        };
        (rates, Output { body: Acceleration { acceleration: rates.body.velocity } })
    }
}

#[cfg(test)]
mod tests;
