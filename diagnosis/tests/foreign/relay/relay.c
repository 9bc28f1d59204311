/* A relay with hysteresis: x' = c in one direction until x reaches w, then in the other until it reaches -w; y' = x. From 0.7 s on it
 * is twice as fast. FMI 2.0, model exchange: one indicator, one event at a known time. */
#include <stdlib.h>
#include <string.h>

enum { C, W, U, X, Y, DX, DY, P, Q, COUNT };
enum { STATES = 2 };
static const double FASTER = 0.7;

typedef struct {
    double r[COUNT], time, direction, gain;
} Model;

typedef int Status;
enum { OK = 0, ERROR = 3 };

static void start(Model *m) {
    memset(m, 0, sizeof *m);
    m->r[C] = 1.3, m->r[W] = 0.3, m->direction = m->gain = 1.0;
}

static void equations(Model *m) {
    double *r = m->r;
    r[DX] = m->direction * m->gain * r[C], r[DY] = r[X];
    r[P] = r[X], r[Q] = r[Y];
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources, const void *callbacks, int visible,
                      int logging) {
    Model *m = malloc(sizeof *m);
    if (m) start(m);
    return m;
}
void fmi2FreeInstance(void *m) { free(m); }
Status fmi2SetDebugLogging(void *m, int on, size_t n, const char *const *categories) { return OK; }
Status fmi2SetupExperiment(void *m, int defined, double tolerance, double begin, int ends, double stop) {
    ((Model *)m)->time = begin;
    return OK;
}
Status fmi2EnterInitializationMode(void *m) { return OK; }
Status fmi2ExitInitializationMode(void *m) { return OK; }
Status fmi2Terminate(void *m) { return OK; }
Status fmi2Reset(void *m) {
    start(m);
    return OK;
}
Status fmi2EnterEventMode(void *m) { return OK; }
Status fmi2EnterContinuousTimeMode(void *m) { return OK; }
Status fmi2CompletedIntegratorStep(void *m, int keep, int *event, int *terminate) {
    *event = *terminate = 0;
    return OK;
}
Status fmi2NewDiscreteStates(void *m, void *info) {
    Model *own = m;
    if (own->direction * own->r[X] >= own->r[W]) own->direction = -own->direction;
    if (own->time >= FASTER) own->gain = 2.0;
    struct {
        int again, terminate, nominals_changed, states_changed, next_event_defined;
        double next_event;
    } said = {0};
    if (own->gain == 1.0) said.next_event_defined = 1, said.next_event = FASTER;
    memcpy(info, &said, sizeof said);
    return OK;
}

Status fmi2GetReal(void *m, const unsigned *references, size_t n, double *values) {
    equations(m);
    for (size_t i = 0; i < n; i++) {
        if (references[i] >= COUNT) return ERROR;
        values[i] = ((Model *)m)->r[references[i]];
    }
    return OK;
}
Status fmi2SetReal(void *m, const unsigned *references, size_t n, const double *values) {
    for (size_t i = 0; i < n; i++) {
        if (references[i] >= COUNT) return ERROR;
        ((Model *)m)->r[references[i]] = values[i];
    }
    return OK;
}
Status fmi2SetTime(void *m, double time) {
    ((Model *)m)->time = time;
    return OK;
}
Status fmi2SetContinuousStates(void *m, const double *x, size_t n) {
    memcpy(((Model *)m)->r + X, x, n * sizeof *x);
    return OK;
}
Status fmi2GetContinuousStates(void *m, double *x, size_t n) {
    memcpy(x, ((Model *)m)->r + X, n * sizeof *x);
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
Status fmi2GetNominalsOfContinuousStates(void *m, double *x, size_t n) {
    for (size_t i = 0; i < n; i++) x[i] = 1.0;
    return OK;
}
