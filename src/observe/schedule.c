// schedule.c -- when an observer looks.
//
// The answer is a pure function of (step, time, dt): nothing is remembered, so a resumed run looks at the same steps. Whether start + k
// every was passed in this step is asked by counting the looks due up to an instant, for this step and for the one before; both counts
// come from one function of the step's number, so that what one step counts as not yet due the next one counts the same: no look is
// missed or doubled. Multiples of dt and of `every` that are meant to be equal differ by round-off; a tolerance takes the look at the
// earlier step.

#include <particls/observe.h>

#include <float.h>

/// Instants closer than this fraction of the step are the same.
static const double same_instant = 1e-9;

/// k dt, start + j every and their quotient, from decimal numbers, are each wrong by some of these (relative).
static const double round_off = 8 * DBL_EPSILON;

static double tolerance(const pls_schedule *schedule, double time, double dt)
{
    return same_instant * dt + round_off * fmax(fabs(time), fabs(schedule->start));
}

/// Time of the step with number 0, had dt always been what it is now; exactly 0 when it has.
static double time_of_step_zero(uint64_t step, double time, double dt)
{
    double origin = time - (double)step * dt;
    return fabs(origin) <= round_off * fabs(time) ? 0 : origin;
}

/// Looks due up to `time`.
static double looks_until(const pls_schedule *schedule, double time, double dt)
{
    double since = time + tolerance(schedule, time, dt) - schedule->start;
    if (since < 0) return 0;
    return schedule->every > 0 ? floor(since / schedule->every) + 1 : 1;
}

static bool due_by_steps(const pls_schedule *schedule, uint64_t step, double origin, double dt)
{
    double wait = schedule->start - tolerance(schedule, schedule->start, dt) - origin;
    double first = wait > 0 ? ceil(wait / dt) : 0; // the first step at or after the start
    if ((double)step < first) return false;
    return (step - (uint64_t)first) % schedule->every_steps == 0;
}

bool pls_schedule_due(const pls_schedule *schedule, uint64_t step, double time, double dt)
{
    double slack = tolerance(schedule, time, dt);
    if (!(time + slack >= schedule->start && time - slack <= schedule->end)) return false;
    if (step == 0) return true;

    double origin = time_of_step_zero(step, time, dt);
    if (schedule->every_steps > 0) return due_by_steps(schedule, step, origin, dt);
    if (schedule->every > 0 && schedule->every <= dt * (1 + same_instant)) return true;
    double now = origin + (double)step * dt;
    double before = origin + (double)(step - 1) * dt;
    return looks_until(schedule, now, dt) > looks_until(schedule, before, dt);
}
