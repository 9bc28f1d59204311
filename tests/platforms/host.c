/* A host that is as small as one can be: loads an FMU's library, steps it, rewinds it, and prints every
 * bit of what comes out. Compiled for each platform; what it prints is the same on all of them.
 *
 *     host LIBRARY GUID RESOURCES SCRIPT
 *
 * RESOURCES is a URI, or "-" for none. SCRIPT is a text of numbers: how many inputs and their value
 * references, outputs likewise, how many steps, the step's size, and the inputs at each step. Numbers that
 * are not whole are written as their 64 bits in hexadecimal: no library is asked to round them.
 */
#define __USE_MINGW_ANSI_STDIO 1
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
static void *library_load(const char *path) { return (void *)LoadLibraryA(path); }
static void *library_find(void *library, const char *name) { return (void *)GetProcAddress(library, name); }
static int library_free(void *library) { return FreeLibrary(library) ? 0 : 1; }
#else
#include <dlfcn.h>
static void *library_load(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *library_find(void *library, const char *name) { return dlsym(library, name); }
static int library_free(void *library) { return dlclose(library); }
#endif

/* FMI 2.0.5, fmi2TypesPlatform.h and fmi2FunctionTypes.h, as far as they are used. */
typedef void *Component, *State;
typedef unsigned Reference;
typedef int Status, Boolean;
typedef struct {
    void (*logger)(void *, const char *, Status, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*free)(void *);
    void (*finished)(void *, Status);
    void *environment;
} Callbacks;

static const char *(*fmi2GetVersion)(void);
static Component (*fmi2Instantiate)(const char *, int, const char *, const char *, const Callbacks *, Boolean, Boolean);
static void (*fmi2FreeInstance)(Component);
static Status (*fmi2SetupExperiment)(Component, Boolean, double, double, Boolean, double);
static Status (*fmi2EnterInitializationMode)(Component);
static Status (*fmi2ExitInitializationMode)(Component);
static Status (*fmi2Reset)(Component);
static Status (*fmi2SetReal)(Component, const Reference[], size_t, const double[]);
static Status (*fmi2GetReal)(Component, const Reference[], size_t, double[]);
static Status (*fmi2GetDirectionalDerivative)(Component, const Reference[], size_t, const Reference[], size_t,
                                              const double[], double[]);
static Status (*fmi2DoStep)(Component, double, double, Boolean);
static Status (*fmi2GetFMUstate)(Component, State *);
static Status (*fmi2SetFMUstate)(Component, State);
static Status (*fmi2FreeFMUstate)(Component, State *);
static Status (*fmi2SerializedFMUstateSize)(Component, State, size_t *);
static Status (*fmi2SerializeFMUstate)(Component, State, char[], size_t);
static Status (*fmi2DeSerializeFMUstate)(Component, const char[], size_t, State *);

static void fail(const char *what) {
    fprintf(stderr, "host: %s\n", what);
    exit(1);
}
#define CALL(call) do { if ((call) != 0) fail(#call); } while (0)

static char message[4096];
static void log_message(void *environment, const char *instance, Status status, const char *category,
                        const char *text, ...) {
    (void)environment, (void)instance, (void)status;
    if (!category) fail("a message without a category");
    va_list arguments;
    va_start(arguments, text);
    vsnprintf(message, sizeof message, text, arguments);
    va_end(arguments);
}

static void print_bits(double value) {
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    printf("%016" PRIx64 " ", bits);
}

static double read_bits(FILE *file) {
    uint64_t bits;
    double value;
    if (fscanf(file, "%" SCNx64, &bits) != 1) fail("the script ends early");
    memcpy(&value, &bits, sizeof value);
    return value;
}

static size_t read_count(FILE *file) {
    unsigned count;
    if (fscanf(file, "%u", &count) != 1) fail("the script ends early");
    return count;
}

static Reference *inputs, *outputs;
static size_t input_count, output_count, steps;
static double size, *driven;

static void initialise(Component instance) {
    CALL(fmi2SetupExperiment(instance, 0, 0.0, 0.0, 0, 0.0));
    CALL(fmi2EnterInitializationMode(instance));
    CALL(fmi2ExitInitializationMode(instance));
}

/* Steps from one to another; the outputs after each go where the step's stand. */
static void run(Component instance, size_t first, size_t last, double *rows) {
    for (size_t step = first; step < last; step++) {
        CALL(fmi2SetReal(instance, inputs, input_count, driven + step * input_count));
        CALL(fmi2DoStep(instance, step * size, size, 0));
        CALL(fmi2GetReal(instance, outputs, output_count, rows + step * output_count));
    }
}

#define FIND(name) do { *(void **)&name = library_find(library, #name); if (!name) fail("no " #name); } while (0)
static void find_all(void *library) {
    FIND(fmi2GetVersion);
    FIND(fmi2Instantiate);
    FIND(fmi2FreeInstance);
    FIND(fmi2SetupExperiment);
    FIND(fmi2EnterInitializationMode);
    FIND(fmi2ExitInitializationMode);
    FIND(fmi2Reset);
    FIND(fmi2SetReal);
    FIND(fmi2GetReal);
    FIND(fmi2GetDirectionalDerivative);
    FIND(fmi2DoStep);
    FIND(fmi2GetFMUstate);
    FIND(fmi2SetFMUstate);
    FIND(fmi2FreeFMUstate);
    FIND(fmi2SerializedFMUstateSize);
    FIND(fmi2SerializeFMUstate);
    FIND(fmi2DeSerializeFMUstate);
}

int main(int count, char **arguments) {
    if (count != 5) fail("usage: host LIBRARY GUID RESOURCES SCRIPT");
    const char *guid = arguments[2], *resources = strcmp(arguments[3], "-") ? arguments[3] : NULL;
    FILE *script = fopen(arguments[4], "r");
    if (!script) fail("no script");
    input_count = read_count(script);
    inputs = calloc(input_count + 1, sizeof *inputs);
    for (size_t i = 0; i < input_count; i++) inputs[i] = read_count(script);
    output_count = read_count(script);
    outputs = calloc(output_count + 1, sizeof *outputs);
    for (size_t i = 0; i < output_count; i++) outputs[i] = read_count(script);
    steps = read_count(script);
    size = read_bits(script);
    driven = calloc(steps * input_count + 1, sizeof *driven);
    for (size_t i = 0; i < steps * input_count; i++) driven[i] = read_bits(script);
    fclose(script);

    void *library = library_load(arguments[1]);
    if (!library) fail("the library does not load");
    find_all(library);
    if (strcmp(fmi2GetVersion(), "2.0")) fail("not FMI 2.0");

    Callbacks callbacks = {log_message, calloc, free, NULL, NULL};
    if (fmi2Instantiate("stranger", 1, "{another}", resources, &callbacks, 0, 1)) fail("a wrong GUID is accepted");
    if (!strstr(message, "GUID")) fail("a wrong GUID is not told");
    Component instance = fmi2Instantiate("one", 1, guid, resources, &callbacks, 0, 1);
    if (!instance) fail(message);
    initialise(instance);

    size_t middle = steps / 2, bytes = steps * output_count * sizeof(double);
    double *onward = calloc(1, bytes), *again = calloc(1, bytes);
    run(instance, 0, middle, onward);
    State state = NULL, received = NULL;
    CALL(fmi2GetFMUstate(instance, &state));
    size_t length;
    CALL(fmi2SerializedFMUstateSize(instance, state, &length));
    char *blob = malloc(length);
    CALL(fmi2SerializeFMUstate(instance, state, blob, length));
    run(instance, middle, steps, onward);
    memcpy(again, onward, middle * output_count * sizeof(double));

    CALL(fmi2SetFMUstate(instance, state));
    run(instance, middle, steps, again);
    if (memcmp(onward, again, bytes)) fail("rewound, it goes another way");
    CALL(fmi2FreeFMUstate(instance, &state));

    Component other = fmi2Instantiate("other", 1, guid, resources, &callbacks, 0, 1);
    if (!other) fail(message);
    initialise(other);
    CALL(fmi2DeSerializeFMUstate(other, blob, length, &received));
    CALL(fmi2SetFMUstate(other, received));
    run(other, middle, steps, again);
    if (memcmp(onward, again, bytes)) fail("another instance with its state goes another way");
    CALL(fmi2FreeFMUstate(other, &received));
    CALL(fmi2Reset(other));
    initialise(other);
    run(other, 0, steps, again);
    if (memcmp(onward, again, bytes)) fail("reset, it goes another way");

    for (size_t row = 0; row < steps; row++, printf("\n"))
        for (size_t i = 0; i < output_count; i++) print_bits(onward[row * output_count + i]);
    for (size_t i = 0; i < input_count; i++, printf("\n")) {
        double seed = 1.0;
        CALL(fmi2GetDirectionalDerivative(instance, outputs, output_count, inputs + i, 1, &seed, again));
        for (size_t j = 0; j < output_count; j++) print_bits(again[j]);
    }
    for (size_t i = 0; i < length; i++) printf("%02x", (unsigned char)blob[i]);
    printf("\n");

    fmi2FreeInstance(instance);
    fmi2FreeInstance(other);
    if (library_free(library)) fail("the library cannot be unloaded");
    return 0;
}
