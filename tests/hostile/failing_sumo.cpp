/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <libsumo/libsumo.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

/* Preloaded into a worker: SUMO, the library, goes wrong. SUMO_FAULT="start 1 abort": at which
 * call, of start (loading a network) or step, and how: abort, segv, exit0, exit3, hang, throw (what
 * SUMO throws), throw_int (what nobody expects), empty (an exception without words). */

namespace
{

void go_wrong(const char *how)
{
    if (std::strcmp(how, "abort") == 0)
        std::abort();
    if (std::strcmp(how, "segv") == 0)
        raise(SIGSEGV);
    if (std::strcmp(how, "exit0") == 0)
        std::exit(0);
    if (std::strcmp(how, "exit3") == 0)
        std::exit(3);
    while (std::strcmp(how, "hang") == 0)
        pause();
    if (std::strcmp(how, "throw") == 0)
        throw std::runtime_error("SUMO's own words");
    if (std::strcmp(how, "empty") == 0)
        throw std::runtime_error("");
    throw 42;
}

void maybe(const char *call, long number)
{
    const char *fault = std::getenv("SUMO_FAULT");
    char where[16] = "", how[16] = "";
    long at = 0;
    if (fault != nullptr && std::sscanf(fault, "%15s %ld %15s", where, &at, how) == 3 &&
        std::strcmp(call, where) == 0 && number == at)
        go_wrong(how);
}

template <typename Function>
Function next_of(const char *name)
{
    Function next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
    if (next == nullptr)
        std::_Exit(99);
    return next;
}

} // namespace

void libsumo::Simulation::step(const double time)
{
    static const auto next = next_of<void (*)(double)>("_ZN7libsumo10Simulation4stepEd");
    static long number = 0;
    maybe("step", ++number);
    next(time);
}

std::pair<int, std::string> libsumo::Simulation::start(const std::vector<std::string> &words,
                                                       int port, int retries,
                                                       const std::string &label, const bool verbose,
                                                       const std::string &trace_file,
                                                       bool trace_getters, void *out)
{
    using Start = std::pair<int, std::string> (*)(const std::vector<std::string> &, int, int,
                                                  const std::string &, bool, const std::string &,
                                                  bool, void *);
    static const Start next = next_of<Start>("_ZN7libsumo10Simulation5startERKSt6vectorINSt7__"
                                             "cxx1112basic_stringIcSt11char_traitsIcESaIcE"
                                             "EESaIS7_EEiiRKS7_bSD_bPv");
    static long number = 0;
    maybe("start", ++number);
    return next(words, port, retries, label, verbose, trace_file, trace_getters, out);
}
