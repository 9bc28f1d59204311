//! Integration allocates no memory: it is called from real-time loops.

use crate::common::*;
use strut_integrators::{IntegrationError, Method};

#[test]
fn advance_allocates_nothing() {
    for method in Method::ALL {
        let mut friction = integrator(method, 1e-8, 1.0);
        let mut hires = integrator(method, 1e-8, 1e-3);
        let mut blow_up = integrator(method, 1e-8, 1.0);
        let counted = allocation_counter::measure(|| {
            let mut x = [0.0; 2];
            run(&mut friction, &mut Friction, 1.0, 1000, &mut x);
            let mut y = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057];
            run(&mut hires, &mut Hires, 10.0, 3, &mut y);
            let failed = blow_up.advance(&mut Linear([[f64::NAN]]), 0.0, 1.0, &mut [1.0]);
            assert!(matches!(failed, Err(IntegrationError::NotFinite { .. })));
        });
        assert!(friction.work().accepted > 1000 && hires.work().accepted > 30);
        assert_eq!((counted.count_total, counted.bytes_total), (0, 0), "{method:?}");
    }
}
