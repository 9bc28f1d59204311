/* A co-simulation master as small as can be: how much faster than real time does a system run?
 *
 *   system STEP STEPS RUNS < PLAN
 *
 * The plan has a line for each component:
 *
 *   component NAME LIBRARY GUID RESOURCES
 *   outputs COUNT REFERENCE...
 *   inputs COUNT REFERENCE PLACE...
 *
 * Outputs are numbered through all components; an input's place is the number of the output it is connected to. At
 * every communication point all outputs are read, then all inputs are set, then every component takes the same step
 * with its inputs held (Jacobi, as examples/jacobi.py). Prints the best time of a step in nanoseconds, and what each
 * component has of it from another run that looks at the clock in between.
 */
#include <math.h>

#include "fmi.h"

enum { COMPONENTS = 64, SIGNALS = 1024 };

typedef struct {
    char name[64];
    Fmi f;
    Component instance;
    unsigned outputs[SIGNALS], inputs[SIGNALS];
    size_t output_count, input_count, first, places[SIGNALS];
    double nanoseconds;
} Part;

static Part parts[COMPONENTS];
static size_t part_count, signal_count;
static double signals[SIGNALS], fed[SIGNALS];

static void expect(int condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "the plan has no %s\n", what);
        exit(1);
    }
}

/* Reads a count and as many references; with places, each reference is followed by one. */
static size_t read_list(const char *kind, unsigned *references, size_t *places) {
    char word[16];
    size_t count = 0;
    expect(scanf("%15s %zu", word, &count) == 2 && !strcmp(word, kind) && count <= SIGNALS, kind);
    for (size_t i = 0; i < count; i++) {
        expect(scanf("%u", &references[i]) == 1, "reference");
        expect(!places || scanf("%zu", &places[i]) == 1, "place");
    }
    return count;
}

static void read_plan(void) {
    char name[64], library[4096], guid[256], resources[4096];
    while (scanf(" component %63s %4095s %255s %4095s", name, library, guid, resources) == 4) {
        expect(part_count < COMPONENTS, "room for as many components");
        Part *part = &parts[part_count++];
        strcpy(part->name, name);
        part->output_count = read_list("outputs", part->outputs, NULL);
        part->input_count = read_list("inputs", part->inputs, part->places);
        part->first = signal_count;
        signal_count += part->output_count;
        expect(signal_count <= SIGNALS, "room for as many signals");
        part->f = open_fmi(library);
        part->instance = instantiate(&part->f, CO_SIMULATION, guid, resources);
    }
    expect(part_count > 0, "component");
}

static void read_outputs(Part *part) {
    if (part->output_count) {
        check(part->f.get(part->instance, part->outputs, part->output_count, signals + part->first), "fmi2GetReal");
    }
}

static void set_inputs(Part *part) {
    if (part->input_count) {
        for (size_t i = 0; i < part->input_count; i++) {
            fed[i] = signals[part->places[i]];
        }
        check(part->f.set(part->instance, part->inputs, part->input_count, fed), "fmi2SetReal");
    }
}

static void exchange(void) {
    for (size_t i = 0; i < part_count; i++) {
        read_outputs(&parts[i]);
    }
    for (size_t i = 0; i < part_count; i++) {
        set_inputs(&parts[i]);
    }
}

/* Initialises all components; a value that passes through one arrives in the next exchange only. */
static void begin(int again) {
    for (size_t i = 0; i < part_count; i++) {
        const Fmi *f = &parts[i].f;
        if (again) {
            check(f->reset(parts[i].instance), "fmi2Reset");
        }
        check(f->setup(parts[i].instance, 0, 0.0, 0.0, 0, 0.0), "fmi2SetupExperiment");
        check(f->enter(parts[i].instance), "fmi2EnterInitializationMode");
    }
    for (size_t i = 0; i < part_count; i++) {
        exchange();
    }
    for (size_t i = 0; i < part_count; i++) {
        check(parts[i].f.leave(parts[i].instance), "fmi2ExitInitializationMode");
    }
}

static double run(double step, long steps) {
    const double start = seconds();
    for (long k = 0; k < steps; k++) {
        exchange();
        for (size_t i = 0; i < part_count; i++) {
            check(parts[i].f.step(parts[i].instance, (double)k * step, step, 1), "fmi2DoStep");
        }
    }
    return seconds() - start;
}

static double nanoseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e9 * (double)now.tv_sec + (double)now.tv_nsec;
}

/* The same with a look at the clock before and after each call. */
static void profile(double step, long steps) {
    for (long k = 0; k < steps; k++) {
        for (size_t i = 0; i < part_count; i++) {
            const double start = nanoseconds();
            read_outputs(&parts[i]);
            parts[i].nanoseconds += nanoseconds() - start;
        }
        for (size_t i = 0; i < part_count; i++) {
            const double start = nanoseconds();
            set_inputs(&parts[i]);
            check(parts[i].f.step(parts[i].instance, (double)k * step, step, 1), "fmi2DoStep");
            parts[i].nanoseconds += nanoseconds() - start;
        }
    }
}

int main(int argc, char **argv) {
    if (argc != 4) {
        fprintf(stderr, "system STEP STEPS RUNS < PLAN\n");
        return 2;
    }
    const double step = atof(argv[1]);
    const long steps = atol(argv[2]);
    read_plan();
    double best = INFINITY, sum = 0.0;
    for (int i = 0; i < atoi(argv[3]); i++) {
        begin(i > 0);
        const double time = run(step, steps);
        best = time < best ? time : best;
    }
    for (size_t i = 0; i < signal_count; i++) {
        sum += signals[i];
    }
    if (!isfinite(sum)) {
        fprintf(stderr, "the system does not stay finite\n");
        return 1;
    }
    begin(1);
    profile(step, steps);
    printf("%.1f\n", 1e9 * best / (double)steps);
    for (size_t i = 0; i < part_count; i++) {
        printf("%s %.1f\n", parts[i].name, parts[i].nanoseconds / (double)steps);
        parts[i].f.release(parts[i].instance);
    }
    return 0;
}
