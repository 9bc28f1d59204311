/* A small FMU of two interfaces with one fault, chosen at compile time by -DFAULT_...; without, it has none.

   dx/dt = rate (u - x), y = x; integrated by Euler's method in steps of a millisecond at most.
   References: 0 x, 1 der(x), 2 u, 3 y, 4 rate (tunable), 5 offset (fixed). */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef FAULT_GLIBC
#include <sys/random.h>
#endif

typedef void *Component;
typedef unsigned int Reference;
typedef int Status;
enum { OK, WARNING, DISCARD, ERROR, FATAL };
typedef void (*Logger)(void *, const char *, Status, const char *, const char *, ...);
typedef struct {
    Logger logger;
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void *finished, *environment;
} Callbacks;
typedef struct { int again, terminate, nominals, states, defined; double next; } EventInfo;
typedef struct { double x, u, rate, offset, time; int stepping; } Values;
typedef struct { Values values; Callbacks callbacks; } Model;

static const Values START = {0.5, 0.0, 2.0, 0.0, 0.0, 0};
#ifdef FAULT_SHARED
static double shared;
#endif

#ifdef FAULT_VERSION
const char *fmi2GetVersion(void) { return "2"; }
#else
const char *fmi2GetVersion(void) { return "2.0"; }
#endif
#ifdef FAULT_TYPES
const char *fmi2GetTypesPlatform(void) { return "mine"; }
#else
const char *fmi2GetTypesPlatform(void) { return "default"; }
#endif

static void fill(double *value, double with) { *value = with; }

Component fmi2Instantiate(const char *name, int kind, const char *guid, const char *resources, const Callbacks *callbacks,
                          int visible, int logging) {
#ifndef FAULT_GUID
    if (strcmp(guid, "{faulty}") != 0) return NULL;
#endif
#ifdef FAULT_SPACES
    /* Takes the address for a path. */
    char path[1024];
    snprintf(path, sizeof path, "%s/data.txt", resources + strlen("file://"));
    FILE *file = fopen(path, "r");
    if (!file) return NULL;
    fclose(file);
#endif
    Model *model = calloc(1, sizeof *model);
#ifdef FAULT_GLIBC
    /* Came with glibc 2.25. */
    char byte;
    getrandom(&byte, 1, 0);
#endif
    model->values = START;
    model->callbacks = *callbacks;
#ifdef FAULT_START
    model->values.rate = 3.0;
#endif
#ifdef FAULT_LEAK
    callbacks->allocate(3, 8);
#endif
#ifdef FAULT_FOREIGN
    callbacks->free(model + 1);
#endif
#ifdef FAULT_LATIN
    callbacks->logger(callbacks->environment, name, OK, "logAll", "K\xe4lte");
#endif
#ifdef FAULT_CATEGORY
    callbacks->logger(callbacks->environment, name, OK, NULL, "hello");
#endif
#ifdef FAULT_NULL
    return NULL;
#endif
    return model;
}

void fmi2FreeInstance(Component c) {
#ifdef FAULT_FREE
    ((volatile Model *)c)->values.x = 0.0;
#endif
    free(c);
}
Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const *categories) { return OK; }
Status fmi2SetupExperiment(Component c, int has, double tolerance, double start, int stop, double end) {
    ((Model *)c)->values.time = start;
    return OK;
}
Status fmi2EnterInitializationMode(Component c) {
#ifdef FAULT_REFUSES
    Model *model = c;
    model->callbacks.logger(model->callbacks.environment, "faulty", ERROR, "error", "it is too cold");
    return ERROR;
#endif
    return OK;
}
Status fmi2ExitInitializationMode(Component c) {
    ((Model *)c)->values.stepping = 1;
    return OK;
}
Status fmi2Terminate(Component c) {
#ifdef FAULT_TERMINATED
    ((Model *)c)->values.x = 0.0;
#endif
    return OK;
}
Status fmi2Reset(Component c) {
#ifdef FAULT_RESET
    double x = ((Model *)c)->values.x;
    ((Model *)c)->values = START;
    ((Model *)c)->values.x = x;
#else
    ((Model *)c)->values = START;
#endif
#ifdef FAULT_START
    ((Model *)c)->values.rate = 3.0;
#endif
    return OK;
}

static double rate(const Values *v) { return v->rate * (v->u - v->x); }

static Status one(Model *model, Reference reference, double *value) {
    Values *v = &model->values;
    switch (reference) {
    case 0: return fill(value, v->x), OK;
    case 1: return fill(value, rate(v)), OK;
    case 2: return fill(value, v->u), OK;
#ifdef FAULT_NAN
    case 3: return fill(value, v->time > 0.01 ? NAN : v->x), OK;
#else
    case 3: return fill(value, v->x + v->offset), OK;
#endif
    case 4: return fill(value, v->rate), OK;
    case 5: return fill(value, v->offset), OK;
    }
#ifdef FAULT_REFERENCE
    return fill(value, 0.0), OK;
#elif defined FAULT_REFERENCE_CRASH
    return fill(value, ((volatile double *)8)[reference]), OK;
#else
    return ERROR;
#endif
}

Status fmi2GetReal(Component c, const Reference *r, size_t n, double *values) {
    Status worst = OK;
    for (size_t i = 0; i < n; i++) if (one(c, r[i], values + i) != OK) worst = ERROR;
    return worst;
}

Status fmi2SetReal(Component c, const Reference *r, size_t n, const double *values) {
    Values *v = &((Model *)c)->values;
    for (size_t i = 0; i < n; i++) {
        switch (r[i]) {
        case 0: v->x = values[i]; break;
        case 2:
            v->u = values[i];
#ifdef FAULT_SHARED
            shared = values[i];
#endif
            break;
        case 4:
#ifdef FAULT_TUNABLE
            if (v->stepping) return ERROR;
#endif
            v->rate = values[i];
            break;
        case 5:
#ifndef FAULT_FIXED
            if (v->stepping) return ERROR;
#endif
            v->offset = values[i];
            break;
        default: return ERROR;
        }
    }
    return OK;
}

#define NONE(name, type) \
    Status fmi2Get##name(Component c, const Reference *r, size_t n, type *v) { return n ? ERROR : OK; } \
    Status fmi2Set##name(Component c, const Reference *r, size_t n, const type *v) { return n ? ERROR : OK; }
NONE(Integer, int)
NONE(Boolean, int)
typedef const char *String;
#ifdef FAULT_TEXT
Status fmi2GetString(Component c, const Reference *r, size_t n, String *v) {
    for (size_t i = 0; i < n; i++) v[i] = NULL;
    return OK;
}
Status fmi2SetString(Component c, const Reference *r, size_t n, const String *v) { return OK; }
#else
NONE(String, String)
#endif

Status fmi2GetFMUstate(Component c, void **state) {
#ifdef FAULT_KEPT
    if (*state) return OK;
#endif
    if (!*state) *state = malloc(sizeof(Values));
    *(Values *)*state = ((Model *)c)->values;
    return OK;
}
Status fmi2SetFMUstate(Component c, void *state) {
#ifdef FAULT_STATE
    ((Model *)c)->values.u = ((Values *)state)->u;
#else
    ((Model *)c)->values = *(Values *)state;
#endif
#ifdef FAULT_RESTART
    /* As a solver that begins anew: the state is there, what comes of it differs a little. */
    ((Model *)c)->values.rate *= 1.0 + 1e-6;
#elif defined FAULT_DRIFT
    ((Model *)c)->values.rate *= 1.1;
#endif
    return OK;
}
#ifdef FAULT_POINTER
Status fmi2FreeFMUstate(Component c, void **state) { return free(*state), OK; }
#else
Status fmi2FreeFMUstate(Component c, void **state) { return free(*state), *state = NULL, OK; }
#endif
Status fmi2SerializedFMUstateSize(Component c, void *state, size_t *size) { return *size = sizeof(Values), OK; }
Status fmi2SerializeFMUstate(Component c, void *state, char *bytes, size_t size) {
    return memcpy(bytes, state, size), OK;
}
Status fmi2DeSerializeFMUstate(Component c, const char *bytes, size_t size, void **state) {
    *state = malloc(size);
    memcpy(*state, bytes, size);
#ifdef FAULT_BYTES
    ((Values *)*state)->x = 0.0;
#endif
    return OK;
}
Status fmi2GetDirectionalDerivative(Component c, const Reference *z, size_t nz, const Reference *v, size_t nv,
                                    const double *seed, double *result) {
#ifdef FAULT_DIRECTIONAL
    return ERROR;
#endif
    for (size_t i = 0; i < nz; i++) result[i] = 0.0;
    return OK;
}

Status fmi2SetRealInputDerivatives(Component c, const Reference *r, size_t n, const int *o, const double *v) { return ERROR; }
Status fmi2GetRealOutputDerivatives(Component c, const Reference *r, size_t n, const int *o, double *v) { return ERROR; }

Status fmi2DoStep(Component c, double time, double size, int keep) {
    Model *model = c;
    Values *v = &model->values;
#ifdef FAULT_CRASH
    if (time > 0.01) return *(volatile int *)8;
#endif
#ifdef FAULT_HANG
    while (time > 0.01) v->x += 1e-9;
#endif
#ifdef FAULT_CLOCK
    if (time != v->time && time > 0.0) return ERROR;
#endif
#ifdef FAULT_SHARED
    v->u = shared;
#endif
#ifdef FAULT_REPEAT
    v->x += 1e-6 * (double)((size_t)&v >> 4 & 0xffff);
#endif
    int count = (int)ceil(size / 1e-3 - 1e-9);
    for (int i = 0; i < count; i++) v->x += size / count * rate(v);
#ifdef FAULT_CLOCK
    /* Knows its own grid, and nothing that is a rounding away from it. */
    v->time = (double)(long)(v->time / size + 1.5) * size;
#else
    v->time = time + size;
#endif
    return OK;
}
Status fmi2CancelStep(Component c) { return ERROR; }
Status fmi2GetStatus(Component c, int kind, Status *status) { return DISCARD; }
Status fmi2GetRealStatus(Component c, int kind, double *value) { return DISCARD; }
Status fmi2GetIntegerStatus(Component c, int kind, int *value) { return DISCARD; }
Status fmi2GetBooleanStatus(Component c, int kind, int *value) { return DISCARD; }
#ifndef FAULT_FUNCTION
Status fmi2GetStringStatus(Component c, int kind, const char **value) { return DISCARD; }
#endif

Status fmi2EnterEventMode(Component c) { return OK; }
Status fmi2NewDiscreteStates(Component c, EventInfo *info) {
    memset(info, 0, sizeof *info);
#ifdef FAULT_EVENTS
    info->again = 1;
#endif
    return OK;
}
Status fmi2EnterContinuousTimeMode(Component c) { return OK; }
Status fmi2CompletedIntegratorStep(Component c, int keep, int *event, int *terminate) {
    return *event = *terminate = 0, OK;
}
Status fmi2SetTime(Component c, double time) { return ((Model *)c)->values.time = time, OK; }
Status fmi2SetContinuousStates(Component c, const double *x, size_t n) {
    return n == 1 ? (((Model *)c)->values.x = x[0], OK) : ERROR;
}
Status fmi2GetDerivatives(Component c, double *rates, size_t n) {
    return n == 1 ? (rates[0] = rate(&((Model *)c)->values), OK) : ERROR;
}
Status fmi2GetEventIndicators(Component c, double *values, size_t n) { return n ? ERROR : OK; }
Status fmi2GetContinuousStates(Component c, double *x, size_t n) {
    return n == 1 ? (x[0] = ((Model *)c)->values.x, OK) : ERROR;
}
Status fmi2GetNominalsOfContinuousStates(Component c, double *x, size_t n) {
#ifdef FAULT_NOMINALS
    x[0] = 0.0;
    return OK;
#endif
    return n == 1 ? (x[0] = 1.0, OK) : ERROR;
}
