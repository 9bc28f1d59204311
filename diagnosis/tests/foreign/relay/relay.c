/* A relay with hysteresis: x' = c in one direction until x reaches w, then in the other until it reaches -w; y' = x. From 0.7 s on it
 * is twice as fast. FMI 2.0, model exchange: one indicator, one event at a known time. */
#include <string.h>

enum { C, W, U, X, Y, DX, DY, P, Q, COUNT };
static const double FASTER = 0.7;

typedef struct {
    double r[COUNT], time, direction, gain;
} Model;

static void start(Model *m) {
    memset(m, 0, sizeof *m);
    m->r[C] = 1.3, m->r[W] = 0.3, m->direction = m->gain = 1.0;
}

static void equations(Model *m) {
    double *r = m->r;
    r[DX] = m->direction * m->gain * r[C], r[DY] = r[X];
    r[P] = r[X], r[Q] = r[Y];
}

#include "../fmu.h"

Status fmi2NewDiscreteStates(void *m, EventInfo *info) {
    Model *own = m;
    if (own->direction * own->r[X] >= own->r[W]) own->direction = -own->direction;
    if (own->time >= FASTER) own->gain = 2.0;
    *info = (EventInfo){.next_event_defined = own->gain == 1.0, .next_event = FASTER};
    return OK;
}
Status fmi2GetDerivatives(void *m, double *rates, size_t n) {
    equations(m);
    memcpy(rates, ((Model *)m)->r + DX, n * sizeof *rates);
    return OK;
}
Status fmi2GetEventIndicators(void *m, double *indicators, size_t n) {
    Model *own = m;
    if (n != 1) return ERROR;
    indicators[0] = own->direction * own->r[X] - own->r[W];
    return OK;
}
