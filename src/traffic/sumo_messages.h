/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TRAFFIC_SUMO_MESSAGES_H
#define TRAFFIC_SUMO_MESSAGES_H

#include "core/error.h"

#include <exception>
#include <sstream>
#include <streambuf>
#include <string>

/* (C++, inside the bridge only.) What SUMO says while it is called: its warnings go on to stderr,
 * and with its errors they become a cp_error. */

// What SUMO writes to its terminal streams while this object lives, kept instead of printed: SUMO's
// exceptions often say only "Process Error", the cause is on std::cerr.
class SumoMessages
{
  public:
    SumoMessages();
    ~SumoMessages();
    SumoMessages(const SumoMessages &) = delete;
    SumoMessages &operator=(const SumoMessages &) = delete;
    std::string text() const
    {
        return text_.str();
    }
    bool is_empty()
    {
        return text_.tellp() == std::streampos(0);
    }

  private:
    std::ostringstream text_;
    std::streambuf *cerr_;
    std::streambuf *cout_;
};

// Warnings of a call that went well: on to the person at the terminal.
void cp_sumo_pass_on(const std::string &printed);

// SUMO's messages and the exception's own text as one line.
std::string cp_sumo_explain(const std::string &printed, const std::string &reason);

// Run call; every exception becomes status with SUMO's words. whose names what was asked.
template <typename Call>
cp_status cp_sumo_guarded(const char *whose, cp_status failure, cp_error *error, Call call)
{
    std::string what, printed;
    try {
        SumoMessages messages;
        try {
            call();
            if (messages.is_empty())
                return CP_OK;
            printed = messages.text();
        } catch (const std::exception &exception) {
            what = exception.what();
            printed = messages.text();
            if (what.empty())
                what = "Process Error";
        } catch (...) {
            what = "unknown exception";
            printed = messages.text();
        }
    } catch (...) {
        return cp_fail_memory(error, "SUMO's messages");
    }
    try {
        if (what.empty()) {
            cp_sumo_pass_on(printed);
            return CP_OK;
        }
        return cp_fail(error, failure, "%s: %s", whose, cp_sumo_explain(printed, what).c_str());
    } catch (...) {
        return cp_fail_memory(error, "SUMO's messages");
    }
}

#endif
