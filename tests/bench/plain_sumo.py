# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that plain 'sumo' needs to do what libsumo does."""

# libsumo holds no input against its schema; Debian's sumo alone comes without the schemas and refuses
# every file that names one.
WITHOUT_SCHEMAS = ["--xml-validation", "never", "--xml-validation.net", "never",
                   "--xml-validation.routes", "never"]
