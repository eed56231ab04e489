# SPDX-License-Identifier: GPL-3.0-or-later
# Write INPUT (one file, or several joined by |, one after the other) as the C byte array SYMBOL (zero-terminated, its size in SYMBOL_size) to OUTPUT.
string(REPLACE "|" ";" files "${INPUT}")
set(hex "")
foreach(file IN LISTS files)
    file(READ ${file} part HEX)
    string(APPEND hex "${part}")
endforeach()
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
string(REGEX REPLACE "((0x..,){20})" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT}
"#include <stddef.h>
extern const unsigned char ${SYMBOL}[];
extern const size_t ${SYMBOL}_size;
const unsigned char ${SYMBOL}[] = {
${bytes}0};
const size_t ${SYMBOL}_size = sizeof ${SYMBOL} - 1;
")
