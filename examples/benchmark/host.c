/* A co-simulation host as small as can be: how long does a step take?
 *
 *   host [tolerance=1e-6] KEY=VALUE...     (see fmi.h)
 *
 * sets the inputs, takes a step and reads the first output, step by step, five times over. Prints the best time
 * per step in nanoseconds.
 */
#include "fmi.h"

int main(int argc, char **argv) {
    Task task;
    const double *excitation = read_task(&task, argc, argv);
    double tolerance = 0.0;
    for (int i = 1; i < argc; i++) {
        sscanf(argv[i], "tolerance=%lf", &tolerance);
    }
    const Fmi f = open_fmi(task.library);
    const Component component = instantiate(&f, CO_SIMULATION, task.guid, task.resources);
    double best = 1e300, value = 0.0;
    for (int run = 0; run < 5; run++) {
        if (run) {
            check(f.reset(component), "fmi2Reset");
        }
        initialize(&f, component, tolerance);
        const double *values = excitation;
        const double start = seconds();
        for (long i = 0; i < task.steps; i++, values += task.input_count) {
            if (task.input_count) {
                check(f.set(component, task.inputs, task.input_count, values), "fmi2SetReal");
            }
            check(f.step(component, (double)i * task.step, task.step, 1), "fmi2DoStep");
            check(f.get(component, task.outputs, 1, &value), "fmi2GetReal");
        }
        const double elapsed = (seconds() - start) / (double)task.steps;
        best = elapsed < best ? elapsed : best;
    }
    f.release(component);
    printf("%.2f\n", 1e9 * best);
    return 0;
}
