/* A quarter car as somebody else would export it: FMI 2.0, model exchange, written by hand, with names, units and signs of
 * its own. The deflection comes in millimetres. It has no friction, no stops, nothing of a catalogue. */
#include <math.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>

enum { M_S, M_U, K_S, D_S, K_T, D_T, Z_R, V_R, F_ACT, X, DX = X + 4, Z_REL = DX + 4, V_REL, A_S, A_U, F_T, F_S, F_U, Z_T,
       V_T, COUNT };
/* States: height and speed of the body, then of the wheel. */
enum { STATES = 4 };

typedef struct {
    double r[COUNT];
    int calls;
} Model;

typedef int Status;
enum { OK = 0, ERROR = 3 };

static void start(Model *m) {
    memset(m, 0, sizeof *m);
    m->r[M_S] = 94.38, m->r[M_U] = 23.92, m->r[K_S] = 8400.0, m->r[D_S] = 707.0, m->r[K_T] = 152140.0, m->r[D_T] = 50.0;
}

static void equations(Model *m) {
    double *r = m->r;
    double lift = r[X] - r[X + 2], speed = r[X + 1] - r[X + 3];
    double strut = r[K_S] * lift + r[D_S] * speed - r[F_ACT];
    /* Further forces, upwards: on the body, and on the wheel from the road. */
    double tyre = r[K_T] * (r[Z_R] - r[X + 2]) + r[D_T] * (r[V_R] - r[X + 3]) + r[F_U];
    r[DX] = r[X + 1], r[DX + 1] = (r[F_S] - strut) / r[M_S];
    r[DX + 2] = r[X + 3], r[DX + 3] = (strut + tyre) / r[M_U];
    r[Z_REL] = 1e3 * lift, r[V_REL] = speed, r[A_S] = r[DX + 1], r[A_U] = r[DX + 3], r[F_T] = tyre;
    r[Z_T] = r[X + 2] - r[Z_R], r[V_T] = r[X + 3] - r[V_R];
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
Status fmi2SetupExperiment(void *m, int defined, double tolerance, double begin, int ends, double stop) { return OK; }
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
Status fmi2NewDiscreteStates(void *m, int *info) {
    /* Five flags and a time: nothing is to be done again. */
    memset(info, 0, 5 * sizeof *info);
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
Status fmi2SetTime(void *m, double time) { return OK; }
Status fmi2SetContinuousStates(void *m, const double *x, size_t n) {
    memcpy(((Model *)m)->r + X, x, n * sizeof *x);
    return OK;
}
Status fmi2GetContinuousStates(void *m, double *x, size_t n) {
    memcpy(x, ((Model *)m)->r + X, n * sizeof *x);
    return OK;
}
Status fmi2GetDerivatives(void *m, double *rates, size_t n) {
#ifdef CRASH_AFTER
    /* As models crash: somewhere in the middle. */
    if (++((Model *)m)->calls > CRASH_AFTER) abort();
#endif
#ifdef NOT_A_NUMBER
    ((Model *)m)->r[K_S] = NAN;
#endif
#ifdef ALONE
    /* As libraries with global state: one instance at a time. */
    static int inside;
    if (__atomic_fetch_add(&inside, 1, __ATOMIC_SEQ_CST)) abort();
    sched_yield();
#endif
    equations(m);
    memcpy(rates, ((Model *)m)->r + DX, n * sizeof *rates);
#ifdef ALONE
    __atomic_fetch_sub(&inside, 1, __ATOMIC_SEQ_CST);
#endif
    return OK;
}
Status fmi2GetEventIndicators(void *m, double *indicators, size_t n) { return n ? ERROR : OK; }
Status fmi2GetNominalsOfContinuousStates(void *m, double *x, size_t n) {
    for (size_t i = 0; i < n; i++) x[i] = 1.0;
    return OK;
}
