/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <libsumo/libsumo.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <dlfcn.h>

/* Preloaded (LD_PRELOAD) into a program that steps SUMO through libsumo, unmodified: before every
 * STEP_CLOCK_EVERYth step a line with the processor time of the process, s, goes to the file
 * STEP_CLOCK. So a run of minutes can be told from another's disturbances stretch by stretch. */

namespace
{

FILE *open_clock()
{
    const char *path = std::getenv("STEP_CLOCK");
    FILE *file = path != nullptr ? std::fopen(path, "w") : nullptr;
    if (file == nullptr) {
        std::fprintf(stderr, "step_clock: cannot write the file STEP_CLOCK names: %s\n",
                     path != nullptr ? path : "none");
        std::exit(1);
    }
    std::setvbuf(file, nullptr, _IOLBF, 0);
    return file;
}

long steps_between()
{
    const char *text = std::getenv("STEP_CLOCK_EVERY");
    const long every = text != nullptr ? std::atol(text) : 0;
    return every > 0 ? every : 10;
}

} // namespace

void libsumo::Simulation::step(const double time)
{
    using Step = void (*)(double);
    static const Step next =
        reinterpret_cast<Step>(dlsym(RTLD_NEXT, "_ZN7libsumo10Simulation4stepEd"));
    static FILE *const clock_file = open_clock();
    static const long every = steps_between();
    static long steps = 0;
    if (steps++ % every == 0) {
        timespec now = {};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
        std::fprintf(clock_file, "%.9f\n",
                     static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec));
    }
    next(time);
}
