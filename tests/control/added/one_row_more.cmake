# SPDX-License-Identifier: GPL-3.0-or-later
# The project's table of controls with one row more: TYPES in, OUTPUT out.
file(READ ${TYPES} text)
string(REPLACE "X(CP_CONTROL_AEB) " "X(CP_CONTROL_AEB) X(CP_CONTROL_HONK) " text "${text}")
file(WRITE ${OUTPUT} "${text}")
