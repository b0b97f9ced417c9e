// skin_tuner.c -- the skin of least work: idle pairs and the making of lists, as part of the work that needs to be done.

#include "step/skin_tuner.h"

#include <math.h>

static const double first_skin = 0.3; ///< of the mean radius
static const double least_skin = 0.02;
static const double most_skin = 1.5;
static const double smaller = 0.85; ///< from one choice to the next
static const double larger = 1.25;  ///< what is tried where lists cost much: 20 % of that is the most it can gain
static const double worth = 0.01;   ///< what a change has to gain, as part of the work per step that needs to be done
static const double forget = 1.1;   ///< per list, of least times: a machine that stays slow is believed after some ten lists
static const int lists_per_choice = 2;
static const int first_patience = 16; ///< choices until a larger skin is tried again after one was too large; twice as many each time
static const int most_patience = 256;

// Work, in that of a pair of balls that touch (docs/performance.md has the times).
static const double body_work = 3.0;        ///< gather, kick, drift and turn
static const double sifted_work = 0.3;      ///< a pair of balls apart, where those that touch are picked
static const double solid_work = 100.0;     ///< a pair of other shapes that touches
static const double idle_solid_work = 10.0; ///< and one that does not

static double least_of_late(double least, double now) { return least > 0.0 ? fmin(forget * least, now) : now; }

void pls_skin_survey(pls_skin_tuner *t, const pls_bodies *bodies, const pls_domain *domain, const pls_near_pairs *near)
{
    size_t within[2 * PLS_SKIN_CHOICES] = {0}; // balls, then others: first those that are in this choice and in no smaller one
    double choice[PLS_SKIN_CHOICES] = {t->skin};
    for (int k = 1; k < PLS_SKIN_CHOICES; ++k) choice[k] = smaller * choice[k - 1];
#pragma omp parallel for schedule(static) reduction(+ : within[:2 * PLS_SKIN_CHOICES])
    for (size_t p = 0; p < near->count; ++p)
    {
        const pls_near_pair *pair = &near->pair[p];
        const pls_body_place *i = &bodies->place[pair->owner], *j = &bodies->place[pair->partner];
        const double x = j->x - i->x + pair->shift[0] * domain->edge[0], y = j->y - i->y + pair->shift[1] * domain->edge[1],
                     z = j->z - i->z + pair->shift[2] * domain->edge[2];
        const double gap = sqrt(x * x + y * y + z * z) - i->radius - j->radius;
        int k = 0;
        while (k + 1 < PLS_SKIN_CHOICES && gap < choice[k + 1]) ++k;
        ++within[pls_pair_is_solid(bodies, pair->owner, pair->partner) * PLS_SKIN_CHOICES + k];
    }
    double *counts[2] = {t->balls, t->solids};
    for (int c = 0; c < 2; ++c)
    {
        size_t sum = 0;
        for (int k = PLS_SKIN_CHOICES; k-- > 0;) counts[c][k] = (double)(sum += within[c * PLS_SKIN_CHOICES + k]);
    }
}

/// What is listed within a choice: pairs that touch are in all of them.
static double listed_work(const pls_skin_tuner *t, int k, double ball_work, double candidates)
{
    // Other shapes have a candidate per pair of parts and, of walls of pieces, which were not counted, per piece.
    const double part = t->solids[0] > 0.0 ? t->solids[k] / t->solids[0] : pow(smaller, k);
    return ball_work * t->balls[k] + idle_solid_work * candidates * part;
}

void pls_skin_choose(pls_skin_tuner *t, const pls_pair_list *list, const pls_solid_list *solids, size_t bodies, double radius,
                     bool worn_out, uint64_t step, double now)
{
    const uint64_t lived = step - t->ready_step;
    if (!worn_out || t->radius == 0.0) // other bodies, laws or threads: what was learned may be wrong by far
    {
        const double first = first_skin * radius, skin = t->skin > 0.0 && radius == t->radius ? t->skin : first;
        *t = (pls_skin_tuner){.skin = skin, .radius = radius};
        return;
    }
    if (lived == 0) return;
    t->step_seconds = least_of_late(t->step_seconds, (now - t->ready) / (double)lived);
    t->lived += lived;
    if (++t->lists < (t->enlarged ? 1 : lists_per_choice)) return;

    const double touching = (double)pls_pair_list_touching(list), solid = (double)pls_solid_list_touching(solids);
    // Whole vectors of the list are worked on where many touch: there a pair that does not costs as much.
    const double ball_work = 4.0 * touching >= (double)list->listed ? 1.0 : sifted_work, candidates = (double)solids->count;
    const double needed = body_work * (double)bodies + touching + solid_work * solid;
    const double idle = ball_work * ((double)list->listed - touching) + idle_solid_work * (candidates - solid);
    const double lists = (needed + idle) * t->list_seconds / t->step_seconds * t->lists / (double)t->lived; // work per step
    int best = 0;
    double least = listed_work(t, 0, ball_work, candidates) + lists - worth * needed, skin = t->skin;
    for (int k = 1; k < PLS_SKIN_CHOICES; ++k)
    {
        const double work = listed_work(t, k, ball_work, candidates) + lists / pow(smaller, k);
        if (work < least) best = k, least = work;
    }
    const bool was_enlarged = t->enlarged;
    t->enlarged = best == 0 && t->wait == 0 && lists * (1.0 - 1.0 / larger) > worth * needed;
    if (best > 0)
    {
        skin *= pow(smaller, best);
        if (t->patience == 0)
            t->patience = first_patience;
        else if (was_enlarged && t->patience < most_patience)
            t->patience *= 2;
        t->wait = t->patience;
    }
    else if (t->wait > 0)
        --t->wait;
    else if (t->enlarged)
        skin *= larger;
    t->skin = fmin(fmax(skin, least_skin * radius), most_skin * radius);
    t->lists = 0;
    t->lived = 0;
}

void pls_skin_listed(pls_skin_tuner *t, uint64_t step, double began, double now)
{
    t->list_seconds = least_of_late(t->list_seconds, now - began);
    t->ready = now;
    t->ready_step = step;
}
