/* What every FMU of these tests does alike. Included after `Model`, with its variables `r` and its `time`, after COUNT and X, where its
 * states begin, and after `start` and `equations`. */
#include <stdlib.h>
#include <string.h>

typedef int Status;
enum { OK = 0, ERROR = 3 };

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
Status fmi2GetNominalsOfContinuousStates(void *m, double *x, size_t n) {
    for (size_t i = 0; i < n; i++) x[i] = 1.0;
    return OK;
}

/* What an event leaves, as the standard lays it out. */
typedef struct {
    int again, terminate, nominals_changed, states_changed, next_event_defined;
    double next_event;
} EventInfo;
