//! Terminals: what belongs to one place of the model, so that a tool connects it in one go.

use strut_model::{Causality, Interface};

use super::schema::{CoordinateSystem, Extent, Graphics, Member, Terminal, Terminals, TerminalsAndIcons};

/// The icon's corners.
const ICON: Extent = Extent { x1: 0, y1: 0, x2: 100, y2: 100 };

/// The groups of inputs and outputs as terminals, whose parts are matched by their names, and the icon. `road.position` is the
/// member `position` of the terminal `road`; a group in a group is a terminal in a terminal.
pub fn terminals(interface: &Interface) -> TerminalsAndIcons {
    let mut items = Vec::new();
    for variable in &interface.variables {
        if matches!(variable.causality, Causality::Input | Causality::Output) {
            let path: Vec<&str> = variable.name.split('.').collect();
            if let Some((member, groups)) = path.split_last()
                && !groups.is_empty()
            {
                add(&mut items, groups, member, &variable.name);
            }
        }
    }
    let system = CoordinateSystem { extent: ICON, scaling: "0.1" };
    TerminalsAndIcons {
        fmi_version: "3.0",
        graphics: Graphics { system, icon: ICON },
        terminals: (!items.is_empty()).then_some(Terminals { items }),
    }
}

/// Adds a member to the terminal of these groups.
fn add(terminals: &mut Vec<Terminal>, groups: &[&str], member: &str, variable: &str) {
    let [name, inner @ ..] = groups else { return };
    let index = terminals.iter().position(|terminal| terminal.name == *name).unwrap_or_else(|| {
        // By name, and what only one side has is left open: a road with a velocity fits a wheel without.
        let empty =
            Terminal { name: (*name).into(), rule: "bus", members: Vec::new(), terminals: Vec::new() };
        terminals.push(empty);
        terminals.len() - 1
    });
    let terminal = &mut terminals[index];
    if inner.is_empty() {
        terminal.members.push(Member { variable: variable.into(), name: member.into(), kind: "signal" });
    } else {
        add(&mut terminal.terminals, inner, member, variable);
    }
}
