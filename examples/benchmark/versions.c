// Steps of one model through several libraries and versions of FMI, in turn: what each costs beside the others.
//
//     versions INPUTS OUTPUTS [VERSION LIBRARY TOKEN RESOURCES]...
//
// The inputs' value references are 0 to INPUTS - 1, those of the outputs follow, as in every FMU of Strut.

#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 201, STEPS = 500, MOST = 64 };

typedef unsigned int Ref;
typedef struct {
    int version;
    void *instance;
    int (*set2)(void *, const Ref *, size_t, const double *);
    int (*get2)(void *, const Ref *, size_t, double *);
    int (*step2)(void *, double, double, int);
    int (*set3)(void *, const Ref *, size_t, const double *, size_t);
    int (*get3)(void *, const Ref *, size_t, double *, size_t);
    int (*step3)(void *, double, double, _Bool, _Bool *, _Bool *, _Bool *, double *);
    double cost[ROUNDS];
    double check;
} Subject;

static void *named(void *library, const char *name) {
    void *found = dlsym(library, name);
    if (!found) {
        fprintf(stderr, "%s is missing\n", name);
        exit(1);
    }
    return found;
}

static void quiet(void *environment, const char *instance, int status, const char *category, const char *text, ...) {
    (void)environment, (void)instance, (void)category;
    fprintf(stderr, "%d: %s\n", status, text);
}

static void quiet3(void *environment, int status, const char *category, const char *text) {
    quiet(environment, "", status, category, text);
}

static void open_two(Subject *it, void *library, const char *token, const char *resources) {
    static struct {
        void (*logger)(void *, const char *, int, const char *, const char *, ...);
        void *others[4];
    } callbacks = {quiet, {0}};
    void *(*make)(const char *, int, const char *, const char *, void *, int, int) = named(library, "fmi2Instantiate");
    int (*set_up)(void *, int, double, double, int, double) = named(library, "fmi2SetupExperiment");
    int (*enter)(void *) = named(library, "fmi2EnterInitializationMode");
    int (*leave)(void *) = named(library, "fmi2ExitInitializationMode");
    it->instance = make("a", 1, token, *resources ? resources : NULL, &callbacks, 0, 0);
    if (!it->instance || set_up(it->instance, 0, 0, 0, 0, 0) || enter(it->instance) || leave(it->instance)) exit(1);
    it->set2 = named(library, "fmi2SetReal");
    it->get2 = named(library, "fmi2GetReal");
    it->step2 = named(library, "fmi2DoStep");
}

static void open_three(Subject *it, void *library, const char *token, const char *resources) {
    void *(*make)(const char *, const char *, const char *, _Bool, _Bool, _Bool, _Bool, const Ref *, size_t, void *,
                  void *, void *) = named(library, "fmi3InstantiateCoSimulation");
    int (*enter)(void *, _Bool, double, double, _Bool, double) = named(library, "fmi3EnterInitializationMode");
    int (*leave)(void *) = named(library, "fmi3ExitInitializationMode");
    it->instance = make("a", token, *resources ? resources : NULL, 0, 0, 0, 0, NULL, 0, NULL, (void *)quiet3, NULL);
    if (!it->instance || enter(it->instance, 0, 0, 0, 0, 0) || leave(it->instance)) exit(1);
    it->set3 = named(library, "fmi3SetFloat64");
    it->get3 = named(library, "fmi3GetFloat64");
    it->step3 = named(library, "fmi3DoStep");
}

static double now(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int main(int count, char **given) {
    static Subject subjects[8];
    size_t inputs = atoi(given[1]), outputs = atoi(given[2]);
    int subject_count = (count - 3) / 4;
    if (inputs > MOST || outputs > MOST || subject_count > 8) return 1;
    for (int i = 0; i < subject_count; i++) {
        char **of = given + 3 + 4 * i;
        void *library = dlopen(of[1], RTLD_NOW | RTLD_LOCAL);
        if (!library) return fprintf(stderr, "%s\n", dlerror()), 1;
        subjects[i].version = atoi(of[0]);
        (subjects[i].version == 2 ? open_two : open_three)(&subjects[i], library, of[2], of[3]);
    }
    Ref in[MOST], out[MOST];
    double u[MOST], y[MOST];
    for (size_t i = 0; i < MOST; i++) in[i] = i, out[i] = inputs + i;
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < subject_count; i++) {
            Subject *it = &subjects[i];
            int status = 0;
            double begin = now();
            for (int k = 0; k < STEPS; k++) {
                double time = (round * STEPS + k) * 1e-3;
                for (size_t n = 0; n < inputs; n++) u[n] = 0.003 * sin(7.0 * time + n);
                if (it->version == 2) {
                    status |= it->set2(it->instance, in, inputs, u);
                    status |= it->step2(it->instance, time, 1e-3, 1);
                    status |= it->get2(it->instance, out, outputs, y);
                } else {
                    _Bool event, end, early;
                    double reached;
                    status |= it->set3(it->instance, in, inputs, u, inputs);
                    status |= it->step3(it->instance, time, 1e-3, 1, &event, &end, &early, &reached);
                    status |= it->get3(it->instance, out, outputs, y, outputs);
                }
            }
            it->cost[round] = (now() - begin) / STEPS * 1e9;
            if (status) return fprintf(stderr, "subject %d fails\n", i), 1;
            for (size_t n = 0; n < outputs; n++) it->check += y[n];
        }
    }
    for (int i = 0; i < subject_count; i++) {
        Subject *it = &subjects[i];
        qsort(it->cost, ROUNDS, sizeof *it->cost, by_size);
        printf("%.2f %.17g\n", it->cost[ROUNDS / 2], it->check);
    }
    return 0;
}
