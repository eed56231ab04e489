/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "traffic/sumo_messages.h"

#include <iostream>
#include <vector>

SumoMessages::SumoMessages()
    : cerr_(std::cerr.rdbuf(text_.rdbuf())), cout_(std::cout.rdbuf(text_.rdbuf()))
{
}

SumoMessages::~SumoMessages()
{
    std::cerr.rdbuf(cerr_);
    std::cout.rdbuf(cout_);
}

namespace
{

// The lines of text that tell something new. Progress ("Loading configuration ... done.") does not,
// nor do collisions and the hard braking before them: they are what a run is for, come by the
// thousand and are read through sumo_bridge_collisions.
std::vector<std::string> telling_lines(const std::string &text)
{
    static const char *const EXPECTED[] = {"collision with", "performs emergency braking"};
    std::istringstream lines(text);
    std::vector<std::string> telling;
    for (std::string line; std::getline(lines, line);) {
        bool is_expected =
            line.empty() || line.rfind("Loading ", 0) == 0 || line.rfind("Quitting", 0) == 0;
        for (const char *words : EXPECTED)
            is_expected |= line.find(words) != std::string::npos;
        if (!is_expected)
            telling.push_back(line);
    }
    return telling;
}

} // namespace

void cp_sumo_pass_on(const std::string &printed)
{
    for (const std::string &line : telling_lines(printed))
        std::cerr << "SUMO: " << line << std::endl;
}

std::string cp_sumo_explain(const std::string &printed, const std::string &reason)
{
    std::string text;
    for (std::string line : telling_lines(printed)) {
        if (line.rfind("Error: ", 0) == 0)
            line.erase(0, 7);
        text += (text.empty() ? "" : "; ") + line;
    }
    bool says_more = reason != "Process Error" && text.find(reason) == std::string::npos;
    if (text.empty())
        return reason;
    return says_more ? reason + ": " + text : text;
}
