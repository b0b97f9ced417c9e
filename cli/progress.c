// progress.c -- on a terminal one line that rewrites itself; elsewhere a plain line every ten seconds.

#include "progress.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double plain_interval = 10; ///< [s]

static volatile int interrupt_flag;

static void on_signal(int number)
{
    if (interrupt_flag)
    {
        signal(number, SIG_DFL);
        raise(number);
    }
    interrupt_flag = 1;
}

static double rate(const cli_progress *progress, const pls_progress *p)
{
    double steps = (double)(p->step - progress->first_step);
    return p->wall > 0 ? (double)p->bodies * steps / p->wall : 0;
}

static void print_bar(const cli_progress *progress, const pls_progress *p)
{
    enum { WIDTH = 24 };
    char bar[WIDTH + 1];
    double part = p->end > 0 ? fmin(fmax(p->time / p->end, 0), 1) : 1;
    int full = (int)(part * WIDTH);
    memset(bar, '.', WIDTH);
    memset(bar, '#', (size_t)full);
    bar[WIDTH] = '\0';
    char left[32];
    printf("\r\033[K[%s] %3.0f %%  t %.4g/%.4g s  step %llu/%llu  %zu bodies  %zu contacts  %.3g M/s  %s left", bar, floor(100 * part),
           p->time, p->end, (unsigned long long)p->step, (unsigned long long)p->steps, p->bodies, p->contacts, 1e-6 * rate(progress, p),
           cli_duration(left, p->remaining));
    fflush(stdout);
}

static void print_plain(const cli_progress *progress, const pls_progress *p)
{
    char left[32];
    printf("t = %.6g of %.6g s, step %llu of %llu, %zu bodies, %zu contacts, %.3g M particle-steps/s, %s left\n", p->time, p->end,
           (unsigned long long)p->step, (unsigned long long)p->steps, p->bodies, p->contacts, 1e-6 * rate(progress, p),
           cli_duration(left, p->remaining));
    fflush(stdout);
}

static void close_line(cli_progress *progress)
{
    if (progress->line_open) printf("\r\033[K");
    progress->line_open = false;
}

/// Written checkpoints are routine; all else is worth a line of its own.
static bool is_routine(const char *event) { return strncmp(event, "checkpoint written", strlen("checkpoint written")) == 0; }

static void on_progress(void *context, const pls_progress *p)
{
    cli_progress *progress = context;
    if (p->event)
    {
        if (is_routine(p->event)) return;
        close_line(progress);
        if (!progress->quiet) printf("%s\n", p->event);
        fflush(stdout);
        return;
    }
    if (!progress->begun) progress->first_step = p->step;
    progress->begun = true;
    progress->last = *p;
    if (progress->quiet) return;
    if (progress->terminal)
    {
        print_bar(progress, p);
        progress->line_open = true;
    }
    else if (p->wall - progress->last_plain >= plain_interval)
    {
        print_plain(progress, p);
        progress->last_plain = p->wall;
    }
}

/// A signal that is ignored (nohup, a job in the background of a script) stays ignored.
static void catch_signal(int number)
{
    struct sigaction before;
    if (sigaction(number, NULL, &before) == 0 && before.sa_handler == SIG_IGN) return;
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

void cli_progress_start(cli_progress *progress, pls_run_def *def, bool quiet)
{
    *progress = (cli_progress){.quiet = quiet, .terminal = isatty(STDOUT_FILENO) == 1};
    def->progress = on_progress;
    def->context = progress;
    def->interrupt = &interrupt_flag;
    catch_signal(SIGINT);
    catch_signal(SIGTERM);
}

int cli_progress_end(cli_progress *progress, pls_status status, const char *directory)
{
    close_line(progress);
    const pls_progress *p = &progress->last;
    if (status != PLS_OK)
    {
        fflush(stdout);
        return cli_failed(progress->begun ? CLI_FAILED : cli_code_of(status)); // what the user can mend shows before the first step
    }
    if (progress->quiet || !progress->begun) return CLI_DONE;
    char wall[32];
    printf("done: t = %.6g s, %llu steps in %s, %.3g M particle-steps/s\n", p->time, (unsigned long long)(p->step - progress->first_step),
           cli_duration(wall, p->wall), 1e-6 * rate(progress, p));
    printf("results in %s: summary.json, series/*.csv, frames/*.pvd (for ParaView); particls info %s lists them\n", directory, directory);
    return CLI_DONE;
}
