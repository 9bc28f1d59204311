/* A quarter car as somebody else would export it: FMI 2.0, model exchange, written by hand, with names, units and signs of
 * its own. The deflection comes in millimetres. It has no friction, no stops, nothing of a catalogue. */
#include <math.h>
#include <sched.h>
#include <string.h>

/* States: height and speed of the body, then of the wheel. */
enum { M_S, M_U, K_S, D_S, K_T, D_T, Z_R, V_R, F_ACT, X, DX = X + 4, Z_REL = DX + 4, V_REL, A_S, A_U, F_T, F_S, F_U, Z_T,
       V_T, COUNT };

typedef struct {
    double r[COUNT], time;
    int calls;
} Model;

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

#include "../fmu.h"

Status fmi2NewDiscreteStates(void *m, EventInfo *info) {
    *info = (EventInfo){0};
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
