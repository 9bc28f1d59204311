/* A co-simulation host as small as can be: how long does a step take?
 *
 *   host LIBRARY GUID RESOURCES STEP STEPS OUTPUT [INPUT=AMPLITUDE...]
 *
 * sets each INPUT (a value reference) to a sine of 2 Hz, takes a step and reads OUTPUT, STEPS times, five
 * times over, and prints the best time per step in nanoseconds and the last value read.
 */
#include <dlfcn.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef void *Component;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

static void logger(void *environment, const char *name, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment;
    va_start(arguments, format);
    fprintf(stderr, "%s [%d %s] ", name, status, category);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

static void *function(void *library, const char *name) {
    void *address = dlsym(library, name);
    if (!address) {
        fprintf(stderr, "%s\n", dlerror());
        exit(1);
    }
    return address;
}

static void check(int status, const char *what) {
    if (status > 1) {
        fprintf(stderr, "%s: status %d\n", what, status);
        exit(1);
    }
}

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int argc, char **argv) {
    static const Callbacks callbacks = {logger, calloc, free, NULL, NULL};
    if (argc < 7) {
        fprintf(stderr, "host LIBRARY GUID RESOURCES STEP STEPS OUTPUT [INPUT=AMPLITUDE...]\n");
        return 2;
    }
    void *library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    Component (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int) =
        function(library, "fmi2Instantiate");
    int (*setup)(Component, int, double, double, int, double) = function(library, "fmi2SetupExperiment");
    int (*enter)(Component) = function(library, "fmi2EnterInitializationMode");
    int (*leave)(Component) = function(library, "fmi2ExitInitializationMode");
    int (*reset)(Component) = function(library, "fmi2Reset");
    int (*set)(Component, const unsigned *, size_t, const double *) = function(library, "fmi2SetReal");
    int (*get)(Component, const unsigned *, size_t, double *) = function(library, "fmi2GetReal");
    int (*step)(Component, double, double, int) = function(library, "fmi2DoStep");
    void (*release)(Component) = function(library, "fmi2FreeInstance");

    const double size = atof(argv[4]);
    const long count = atol(argv[5]);
    const unsigned output = (unsigned)atoi(argv[6]);
    unsigned inputs[16];
    double amplitudes[16], values[16];
    const size_t driven = (size_t)(argc - 7) < 16 ? (size_t)(argc - 7) : 16;
    for (size_t i = 0; i < driven; i++) {
        char *amplitude;
        inputs[i] = (unsigned)strtoul(argv[7 + i], &amplitude, 10);
        amplitudes[i] = atof(amplitude + 1);
    }
    Component component = instantiate("benchmark", 1, argv[2], argv[3], &callbacks, 0, 0);
    if (!component) {
        return 1;
    }
    double best = INFINITY, value = 0.0;
    for (int run = 0; run < 5; run++) {
        if (run) {
            check(reset(component), "fmi2Reset");
        }
        /* An integration that controls its error is asked for 1e-6. */
        check(setup(component, 1, 1e-6, 0.0, 0, 0.0), "fmi2SetupExperiment");
        check(enter(component), "fmi2EnterInitializationMode");
        check(leave(component), "fmi2ExitInitializationMode");
        /* The sine turns on the spot: calling one would cost as much as a step. */
        const double turn_cos = cos(2.0 * 3.14159265358979 * 2.0 * size), turn_sin = sin(2.0 * 3.14159265358979 * 2.0 * size);
        double c = 1.0, s = 0.0;
        const double start = seconds();
        for (long i = 0; i < count; i++) {
            if (driven) {
                const double next = c * turn_cos - s * turn_sin;
                s = s * turn_cos + c * turn_sin;
                c = next;
                for (size_t k = 0; k < driven; k++) {
                    values[k] = amplitudes[k] * s;
                }
                check(set(component, inputs, driven, values), "fmi2SetReal");
            }
            check(step(component, (double)i * size, size, 1), "fmi2DoStep");
            check(get(component, &output, 1, &value), "fmi2GetReal");
        }
        const double elapsed = (seconds() - start) / (double)count;
        best = elapsed < best ? elapsed : best;
    }
    release(component);
    printf("%.2f %.17g\n", 1e9 * best, value);
    return 0;
}
