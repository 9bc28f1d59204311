/* An FMU's own integration beside SUNDIALS on the same right-hand side, called through the FMU's model exchange side,
 * as an importer would.
 *
 *   sundials method=bdf|adams|erk [iteration=newton|exact|fixed] [restart=0] [repeats=3] KEY=VALUE...   (see fmi.h)
 *
 * The method is one of CVODE's or ARKODE's explicit Runge-Kutta method of Dormand and Prince. CVODE's iteration is
 * Newton's with difference quotients, Newton's with the FMU's exact directional derivatives, or functional.
 *
 * Both go through the same communication steps with the same inputs, which are held from point to point and jump
 * there; so the solver is restarted at every point (restart=0 leaves that out).
 *
 * Over a ladder of tolerances, alternating, one line each is printed:
 *
 *   fmu  TOLERANCE ERROR NS RATES STEPS REJECTED JACOBIANS
 *   peer TOLERANCE ERROR NS RATES STEPS REJECTED JACOBIANS
 *
 * TOLERANCE 0 is the FMU's own default. ERROR is the largest deviation of a state at a communication point, as a
 * fraction of the state's range: for the FMU from ARKODE's result at a tolerance of 1e-13, for SUNDIALS from the FMU's,
 * so that none is its own judge. It is infinite where a solver fails. NS and the counts are for one communication step.
 * Before these lines stand the deviation of those two results from each other ("floor"), and the times of one right-hand side ("call") and one exact Jacobian ("matrix")
 * through the FMU's functions.
 */
#include "fmi.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_types.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#define MOST 64

typedef struct {
    double ns, rates, steps, rejected, jacobians;
} Cost;

typedef enum { BDF, ADAMS, ERK } Method;
typedef enum { NEWTON, EXACT, FIXED } Iteration;

typedef struct {
    const Fmi *f;
    const Task *task;
    const double *excitation;
    Component component;
    Method method;
    Iteration iteration;
    int restart;
} Problem;

static void succeed(int flag, const char *what) {
    if (flag < 0) {
        fprintf(stderr, "%s: %d\n", what, flag);
        exit(1);
    }
}

/* ---- the right-hand side ---- */

static int right_hand_side(realtype t, N_Vector x, N_Vector rates, void *data) {
    const Problem *p = data;
    const size_t n = p->task->state_count;
    int status = p->f->set_time(p->component, t);
    status |= p->f->set_states(p->component, N_VGetArrayPointer(x), n);
    status |= p->f->rates(p->component, N_VGetArrayPointer(rates), n);
    return status > 1;
}

static int exact_jacobian(const Problem *p, double t, const double *x, double **columns) {
    const Task *task = p->task;
    const size_t n = task->state_count;
    const double one = 1.0;
    int status = p->f->set_time(p->component, t);
    status |= p->f->set_states(p->component, x, n);
    for (size_t j = 0; j < n; j++) {
        status |= p->f->derivative(p->component, task->rates, n, &task->states[j], 1, &one, columns[j]);
    }
    return status > 1;
}

static int jacobian(realtype t, N_Vector x, N_Vector rates, SUNMatrix matrix, void *data, N_Vector a, N_Vector b, N_Vector c) {
    (void)rates, (void)a, (void)b, (void)c;
    return exact_jacobian(data, t, N_VGetArrayPointer(x), SM_COLS_D(matrix));
}

/* ---- the solvers ---- */

typedef struct {
    void *memory;
    SUNContext context;
    N_Vector x, absolute;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver fixed;
} Solver;

static Solver open_solver(Problem *p, double tolerance) {
    const sunindextype n = (sunindextype)p->task->state_count;
    Solver s = {0};
    SUNContext_Create(NULL, &s.context);
    s.x = N_VNew_Serial(n, s.context);
    s.absolute = N_VNew_Serial(n, s.context);
    check(p->f->get_states(p->component, N_VGetArrayPointer(s.x), (size_t)n), "fmi2GetContinuousStates");
    check(p->f->nominals(p->component, N_VGetArrayPointer(s.absolute), (size_t)n), "fmi2GetNominalsOfContinuousStates");
    /* As the FMU does it, and as FMI importers do. */
    N_VScale(0.01 * tolerance, s.absolute, s.absolute);
    if (p->method == ERK) {
        s.memory = ERKStepCreate(right_hand_side, 0.0, s.x, s.context);
        succeed(ERKStepSetTableNum(s.memory, ARKODE_DORMAND_PRINCE_7_4_5), "ERKStepSetTableNum");
        succeed(ERKStepSVtolerances(s.memory, tolerance, s.absolute), "ERKStepSVtolerances");
        succeed(ERKStepSetUserData(s.memory, p), "ERKStepSetUserData");
        succeed(ERKStepSetMaxNumSteps(s.memory, 1000000), "ERKStepSetMaxNumSteps");
        succeed(ERKStepSetErrFile(s.memory, NULL), "ERKStepSetErrFile");
        return s;
    }
    s.memory = CVodeCreate(p->method == ADAMS ? CV_ADAMS : CV_BDF, s.context);
    succeed(CVodeInit(s.memory, right_hand_side, 0.0, s.x), "CVodeInit");
    succeed(CVodeSVtolerances(s.memory, tolerance, s.absolute), "CVodeSVtolerances");
    succeed(CVodeSetUserData(s.memory, p), "CVodeSetUserData");
    succeed(CVodeSetMaxNumSteps(s.memory, 1000000), "CVodeSetMaxNumSteps");
    succeed(CVodeSetErrFile(s.memory, NULL), "CVodeSetErrFile");
    if (p->iteration == FIXED) {
        s.fixed = SUNNonlinSol_FixedPoint(s.x, 0, s.context);
        succeed(CVodeSetNonlinearSolver(s.memory, s.fixed), "CVodeSetNonlinearSolver");
        return s;
    }
    s.matrix = SUNDenseMatrix(n, n, s.context);
    s.linear = SUNLinSol_Dense(s.x, s.matrix, s.context);
    succeed(CVodeSetLinearSolver(s.memory, s.linear, s.matrix), "CVodeSetLinearSolver");
    if (p->iteration == EXACT) {
        succeed(CVodeSetJacFn(s.memory, jacobian), "CVodeSetJacFn");
    }
    return s;
}

static void close_solver(const Problem *p, Solver *s) {
    if (p->method == ERK) {
        ERKStepFree(&s->memory);
    } else {
        CVodeFree(&s->memory);
    }
    if (s->fixed) SUNNonlinSolFree(s->fixed);
    if (s->linear) SUNLinSolFree(s->linear);
    if (s->matrix) SUNMatDestroy(s->matrix);
    N_VDestroy(s->x);
    N_VDestroy(s->absolute);
    SUNContext_Free(&s->context);
}

/* Adds what was done since the last restart. */
static void add_counts(const Problem *p, const Solver *s, Cost *cost) {
    long steps = 0, rates = 0, implicit = 0, rejected = 0, jacobians = 0;
    if (p->method == ERK) {
        ERKStepGetNumSteps(s->memory, &steps);
        ERKStepGetNumRhsEvals(s->memory, &rates);
        ERKStepGetNumErrTestFails(s->memory, &rejected);
    } else {
        CVodeGetNumSteps(s->memory, &steps);
        CVodeGetNumRhsEvals(s->memory, &rates);
        CVodeGetNumErrTestFails(s->memory, &rejected);
        if (s->linear) {
            CVodeGetNumLinRhsEvals(s->memory, &implicit);
            CVodeGetNumJacEvals(s->memory, &jacobians);
        }
    }
    cost->steps += (double)steps;
    cost->rates += (double)(rates + implicit);
    cost->rejected += (double)rejected;
    cost->jacobians += (double)jacobians;
}

static void restart(const Problem *p, const Solver *s, double t) {
    if (p->method == ERK) {
        succeed(ERKStepReInit(s->memory, right_hand_side, t, s->x), "ERKStepReInit");
    } else {
        succeed(CVodeReInit(s->memory, t, s->x), "CVodeReInit");
    }
}

/* Whether the solver gets there. */
static int go(const Problem *p, const Solver *s, double end) {
    double reached;
    if (p->method == ERK) {
        succeed(ERKStepSetStopTime(s->memory, end), "ERKStepSetStopTime");
        return ERKStepEvolve(s->memory, end, s->x, &reached, ARK_NORMAL) >= 0;
    }
    succeed(CVodeSetStopTime(s->memory, end), "CVodeSetStopTime");
    return CVode(s->memory, end, s->x, &reached, CV_NORMAL) >= 0;
}

/* ---- runs ---- */

/* With the FMU's own integration. */
static Cost run_fmu(const Problem *p, double tolerance, double *trace) {
    static const char *const category = "logSolver";
    static const char *const sentence =
        ": the integration took %lf steps and tried %lf that were too long, with %lf evaluations of the rates and %lf Jacobians";
    const Fmi *f = p->f;
    const Task *task = p->task;
    check(f->reset(p->component), "fmi2Reset");
    initialize(f, p->component, tolerance);
    check(f->set_debug_logging(p->component, 1, 1, &category), "fmi2SetDebugLogging");
    const double *values = p->excitation;
    double value;
    const double start = seconds();
    for (long i = 0; i < task->steps; i++, values += task->input_count) {
        if (task->input_count) {
            check(f->set(p->component, task->inputs, task->input_count, values), "fmi2SetReal");
        }
        check(f->step(p->component, (double)i * task->step, task->step, 1), "fmi2DoStep");
        if (trace) {
            check(f->get(p->component, task->states, task->state_count, trace), "fmi2GetReal");
            trace += task->state_count;
        } else {
            check(f->get(p->component, task->outputs, 1, &value), "fmi2GetReal");
        }
    }
    Cost cost = {1e9 * (seconds() - start), 0, 0, 0, 0};
    check(f->terminate(p->component), "fmi2Terminate");
    const char *numbers = strchr(solver_message, ':');
    if (!numbers || sscanf(numbers, sentence, &cost.steps, &cost.rejected, &cost.rates, &cost.jacobians) != 4) {
        fprintf(stderr, "the FMU does not say what the integration has cost: \"%s\"\n", solver_message);
        exit(1);
    }
    return cost;
}

static void hand_over(const Problem *p, const Solver *s, double t) {
    check(p->f->set_time(p->component, t), "fmi2SetTime");
    check(p->f->set_states(p->component, N_VGetArrayPointer(s->x), p->task->state_count), "fmi2SetContinuousStates");
}

/* Makes the ticks that are due. */
static EventInfo tick(const Problem *p) {
    EventInfo event;
    do {
        check(p->f->new_discrete(p->component, &event), "fmi2NewDiscreteStates");
    } while (event.needed);
    check(p->f->enter_continuous(p->component), "fmi2EnterContinuousTimeMode");
    return event;
}

/* With SUNDIALS. A run that fails costs an infinite time. */
static Cost run_peer(Problem *p, double tolerance, double *trace) {
    const Fmi *f = p->f;
    const Task *task = p->task;
    const size_t n = task->state_count;
    check(f->reset(p->component), "fmi2Reset");
    initialize(f, p->component, 0.0);
    /* The first tick sees the inputs of the first step. */
    if (task->input_count) {
        check(f->set(p->component, task->inputs, task->input_count, p->excitation), "fmi2SetReal");
    }
    EventInfo event = tick(p);
    Solver s = open_solver(p, tolerance);
    Cost cost = {0};
    double value;
    const double *values = p->excitation;
    const double start = seconds();
    for (long i = 0; i < task->steps; i++, values += task->input_count) {
        const double begin = (double)i * task->step, end = (double)(i + 1) * task->step, near = 1e-9 * task->step;
        /* Without inputs nothing jumps at a communication point. */
        int jump = i > 0 && task->input_count > 0;
        if (task->input_count) {
            check(f->set(p->component, task->inputs, task->input_count, values), "fmi2SetReal");
        }
        for (double t = begin, stop; t < end; t = stop) {
            if (event.next_defined && event.next <= t + near) {
                hand_over(p, &s, t);
                check(f->enter_event(p->component), "fmi2EnterEventMode");
                event = tick(p);
                jump = 1;
            }
            stop = event.next_defined && event.next < end - near ? event.next : end;
            if (jump && p->restart) {
                add_counts(p, &s, &cost);
                restart(p, &s, t);
                jump = 0;
            }
            if (!go(p, &s, stop)) {
                close_solver(p, &s);
                return (Cost){.ns = INFINITY};
            }
        }
        if (trace) {
            memcpy(trace, N_VGetArrayPointer(s.x), n * sizeof *trace);
            trace += n;
        } else {
            hand_over(p, &s, end);
            check(f->get(p->component, task->outputs, 1, &value), "fmi2GetReal");
        }
    }
    cost.ns = 1e9 * (seconds() - start);
    add_counts(p, &s, &cost);
    close_solver(p, &s);
    return cost;
}

/* What one call of the right-hand side, or one Jacobian, costs through the FMU's functions. */
static double call_ns(const Problem *p, const double *trace, int matrix) {
    const Task *task = p->task;
    const size_t n = task->state_count;
    double numbers[MOST], *columns[MOST], best = INFINITY;
    for (size_t j = 0; j < n; j++) {
        columns[j] = numbers;
    }
    check(p->f->reset(p->component), "fmi2Reset");
    initialize(p->f, p->component, 0.0);
    tick(p);
    for (int run = 0; run < 5; run++) {
        const double start = seconds();
        for (long i = 0; i < task->steps; i++, trace += n) {
            if (matrix) {
                exact_jacobian(p, (double)i * task->step, trace, columns);
            } else {
                p->f->set_time(p->component, (double)i * task->step);
                p->f->set_states(p->component, trace, n);
                p->f->rates(p->component, numbers, n);
            }
        }
        best = fmin(best, (seconds() - start) / (double)task->steps);
        trace -= (size_t)task->steps * n;
    }
    return 1e9 * best;
}

/* The largest deviation of a state, as a fraction of its range in the reference. */
static double deviation(const Task *task, const double *a, const double *reference) {
    const size_t n = task->state_count;
    double largest = 0.0;
    for (size_t k = 0; k < n; k++) {
        double low = INFINITY, high = -INFINITY, worst = 0.0;
        for (size_t i = k; i < (size_t)task->steps * n; i += n) {
            low = fmin(low, reference[i]);
            high = fmax(high, reference[i]);
            worst = fmax(worst, fabs(a[i] - reference[i]));
        }
        /* A state that stays where it is has no range: its magnitude is the measure. */
        const double range = high > low ? high - low : fmax(fabs(high), 1.0);
        largest = fmax(largest, worst / range);
    }
    return largest;
}

static void print(const char *who, double tolerance, double error, Cost cost, long steps) {
    const double by = 1.0 / (double)steps;
    printf("%s %g %.3e %.1f %.3f %.3f %.4f %.3f\n", who, tolerance, error, cost.ns * by, cost.rates * by, cost.steps * by,
           cost.rejected * by, cost.jacobians * by);
}

int main(int argc, char **argv) {
    Task task;
    const double *excitation = read_task(&task, argc, argv);
    const Fmi f = open_fmi(task.library);
    Problem own = {.f = &f, .task = &task, .excitation = excitation, .restart = 1}, other = own;
    int repeats = 3;
    for (int i = 1; i < argc; i++) {
        sscanf(argv[i], "repeats=%d", &repeats);
        if (!strcmp(argv[i], "method=adams")) other.method = ADAMS;
        if (!strcmp(argv[i], "method=erk")) other.method = ERK;
        if (!strcmp(argv[i], "iteration=exact")) other.iteration = EXACT;
        if (!strcmp(argv[i], "iteration=fixed")) other.iteration = FIXED;
        if (!strcmp(argv[i], "restart=0")) other.restart = 0;
    }
    own.component = instantiate(&f, CO_SIMULATION, task.guid, task.resources);
    other.component = instantiate(&f, MODEL_EXCHANGE, task.guid, task.resources);
    const size_t size = (size_t)task.steps * task.state_count;
    double *trace = calloc(size, sizeof *trace);
    double *tight_own = calloc(size, sizeof *trace), *tight_other = calloc(size, sizeof *trace);

    Problem reference = other;
    reference.method = ERK;
    run_fmu(&own, 1e-13, tight_own);
    if (run_peer(&reference, 1e-13, tight_other).ns == INFINITY) {
        fprintf(stderr, "there is no reference: ARKODE does not get through at a tolerance of 1e-13\n");
        return 1;
    }
    printf("floor %.3e\n", deviation(&task, tight_own, tight_other));
    printf("call %.1f\n", call_ns(&other, tight_own, 0));
    printf("matrix %.1f\n", call_ns(&other, tight_own, 1));

    static const double ladder[] = {0.0, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
    enum { RUNGS = sizeof ladder / sizeof *ladder };
    double own_error[RUNGS], other_error[RUNGS];
    for (int rung = 0; rung < RUNGS; rung++) {
        run_fmu(&own, ladder[rung], trace);
        own_error[rung] = deviation(&task, trace, tight_other);
        if (ladder[rung] > 0.0) {
            const Cost cost = run_peer(&other, ladder[rung], trace);
            other_error[rung] = cost.ns < INFINITY ? deviation(&task, trace, tight_own) : INFINITY;
        }
    }
    for (int repeat = 0; repeat < repeats; repeat++) {
        for (int rung = 0; rung < RUNGS; rung++) {
            print("fmu", ladder[rung], own_error[rung], run_fmu(&own, ladder[rung], NULL), task.steps);
            if (ladder[rung] > 0.0) {
                print("peer", ladder[rung], other_error[rung], run_peer(&other, ladder[rung], NULL), task.steps);
            }
        }
    }
    f.release(own.component);
    f.release(other.component);
    return 0;
}
