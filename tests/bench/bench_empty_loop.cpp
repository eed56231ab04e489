/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <libsumo/libsumo.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

/* bench_empty_loop STEPS SUMO_WORD...: what SUMO itself costs inside a program, nothing read and
 * nothing done. */

int main(int argc, char **argv)
{
    if (argc < 3) {
        std::cerr << "bench_empty_loop STEPS SUMO_WORD...\n";
        return 2;
    }
    const std::vector<std::string> words(argv + 2, argv + argc);
    libsumo::Simulation::start(words);
    for (long step = std::atol(argv[1]); step > 0; step--)
        libsumo::Simulation::step();
    libsumo::Simulation::close();
    return 0;
}
