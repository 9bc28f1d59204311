/* As much of FMI 2.0 as the benchmarks call, from a library that is opened at run time. */
#ifndef FMI_H
#define FMI_H

#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MODEL_EXCHANGE = 0, CO_SIMULATION = 1 };

typedef void *Component;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;
typedef struct {
    int needed, terminate, nominals_changed, values_changed, next_defined;
    double next;
} EventInfo;

typedef struct {
    Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    void (*release)(Component);
    int (*set_debug_logging)(Component, int, size_t, const char *const *);
    int (*setup)(Component, int, double, double, int, double);
    int (*enter)(Component), (*leave)(Component), (*terminate)(Component), (*reset)(Component);
    int (*set)(Component, const unsigned *, size_t, const double *);
    int (*get)(Component, const unsigned *, size_t, double *);
    int (*step)(Component, double, double, int);
    int (*enter_event)(Component), (*enter_continuous)(Component);
    int (*new_discrete)(Component, EventInfo *);
    int (*set_time)(Component, double);
    int (*set_states)(Component, const double *, size_t);
    int (*get_states)(Component, double *, size_t);
    int (*nominals)(Component, double *, size_t);
    int (*rates)(Component, double *, size_t);
    int (*derivative)(Component, const unsigned *, size_t, const unsigned *, size_t, const double *, double *);
} Fmi;

static int check(int status, const char *what) {
    if (status > 1) {
        fprintf(stderr, "%s: status %d\n", what, status);
        exit(1);
    }
    return status;
}

/* Opens a library. The functions of a side that an FMU does not have are null. */
static inline Fmi open_fmi(const char *path) {
    void *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    Fmi f;
    memset(&f, 0, sizeof f);
#define FIND(field, name) *(void **)&f.field = dlsym(library, "fmi2" name)
    FIND(instantiate, "Instantiate");
    FIND(release, "FreeInstance");
    FIND(set_debug_logging, "SetDebugLogging");
    FIND(setup, "SetupExperiment");
    FIND(enter, "EnterInitializationMode");
    FIND(leave, "ExitInitializationMode");
    FIND(terminate, "Terminate");
    FIND(reset, "Reset");
    FIND(set, "SetReal");
    FIND(get, "GetReal");
    FIND(step, "DoStep");
    FIND(enter_event, "EnterEventMode");
    FIND(enter_continuous, "EnterContinuousTimeMode");
    FIND(new_discrete, "NewDiscreteStates");
    FIND(set_time, "SetTime");
    FIND(set_states, "SetContinuousStates");
    FIND(get_states, "GetContinuousStates");
    FIND(nominals, "GetNominalsOfContinuousStates");
    FIND(rates, "GetDerivatives");
    FIND(derivative, "GetDirectionalDerivative");
#undef FIND
    if (!f.instantiate || !f.setup || !f.get) {
        fprintf(stderr, "%s is not the library of an FMU of version 2.0\n", path);
        exit(1);
    }
    return f;
}

/* The last message of the category logSolver: what the integration has cost. */
static char solver_message[512];

static void logger(void *environment, const char *name, int status, const char *category, const char *format, ...) {
    char text[512];
    va_list arguments;
    (void)environment;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (category && !strcmp(category, "logSolver")) {
        strcpy(solver_message, text);
    } else if (status) {
        fprintf(stderr, "%s [%d %s] %s\n", name, status, category, text);
    }
}

static const Callbacks callbacks = {logger, calloc, free, NULL, NULL};

static inline Component instantiate(const Fmi *f, int kind, const char *guid, const char *resources) {
    Component component = f->instantiate("benchmark", kind, guid, resources, &callbacks, 0, 0);
    if (!component) {
        exit(1);
    }
    return component;
}

/* Initialises an instance; a tolerance of zero is the FMU's own. */
static inline void initialize(const Fmi *f, Component component, double tolerance) {
    check(f->setup(component, tolerance > 0.0, tolerance, 0.0, 0, 0.0), "fmi2SetupExperiment");
    check(f->enter(component), "fmi2EnterInitializationMode");
    check(f->leave(component), "fmi2ExitInitializationMode");
}

/* The processor's time, not the wall's: other programs run as well. */
static inline double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* What the hosts are told: the FMU, the step, and a file with the inputs' values, step by step. */
typedef struct {
    const char *library, *guid, *resources;
    double step;
    long steps;
    const char *excitation;
    unsigned inputs[64], outputs[64], states[64], rates[64];
    size_t input_count, output_count, state_count, rate_count;
} Task;

static inline size_t references(const char *list, unsigned *into) {
    size_t count = 0;
    for (char *end; *list && count < 64; list = *end ? end + 1 : end) {
        into[count++] = (unsigned)strtoul(list, &end, 10);
    }
    return count;
}

/* Reads KEY=VALUE arguments; returns the excitation, steps times inputs. */
static inline double *read_task(Task *task, int argc, char **argv) {
    memset(task, 0, sizeof *task);
    for (int i = 1; i < argc; i++) {
        char *value = strchr(argv[i], '=');
        if (!value) {
            continue;
        }
        const size_t length = (size_t)(value++ - argv[i]);
#define KEY(name) (length == sizeof name - 1 && !strncmp(argv[i], name, length))
        if (KEY("library")) task->library = value;
        if (KEY("guid")) task->guid = value;
        if (KEY("resources")) task->resources = value;
        if (KEY("step")) task->step = atof(value);
        if (KEY("steps")) task->steps = atol(value);
        if (KEY("excitation")) task->excitation = value;
        if (KEY("inputs")) task->input_count = references(value, task->inputs);
        if (KEY("outputs")) task->output_count = references(value, task->outputs);
        if (KEY("states")) task->state_count = references(value, task->states);
        if (KEY("rates")) task->rate_count = references(value, task->rates);
#undef KEY
    }
    const size_t count = (size_t)task->steps * task->input_count;
    double *excitation = malloc((count + 1) * sizeof *excitation);
    FILE *file = fopen(task->excitation, "rb");
    if (!file || fread(excitation, sizeof *excitation, count, file) != count) {
        fprintf(stderr, "cannot read %zu numbers from %s\n", count, task->excitation);
        exit(1);
    }
    fclose(file);
    return excitation;
}

#endif
