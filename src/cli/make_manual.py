# SPDX-License-Identifier: GPL-3.0-or-later
"""make_manual.py CRASHPULSE FOLDER: manual pages (FOLDER/man1/crashpulse*.1) and completion for bash
(FOLDER/crashpulse.bash), both from what the program says of itself with --help, which argp makes from its tables."""
import pathlib
import re
import subprocess
import sys

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
GLOBAL = [("--quiet", ""), ("--verbose", ""), ("--log-format", "FORMAT")]


def output(*words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def escape(text):
    """For roff: no escapes, minus signs that can be copied, no request at the beginning of a line."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def commands():
    """(name, what) of every command, from the program's own help."""
    listed = re.search(r"\n\n((?:  \S.*\n)+)\n", output("--help")).group(1)
    return re.findall(r"^  (\S+) +(.*)$", listed, re.M)


def options(text):
    """(names, explanation) of every option of a command's help, lines put together again."""
    found, at = [], None
    for line in text.splitlines():
        head = re.match(r"^ {1,6}(-\S.*?)(?: {2,}(.*))?$", line)
        if head and len(line) - len(line.lstrip()) <= 6:
            at = [head.group(1), [head.group(2) or ""]]
            found.append(at)
        elif at is not None and line.startswith(" " * 20):
            at[1].append(line.strip())
        else:
            at = None
    return [(names, " ".join(part for part in words if part)) for names, words in found]


def sections(text):
    """Usage lines, what comes before the options, the options, what comes behind."""
    lines = text.splitlines()
    usage = []
    while lines and (lines[0].startswith("Usage:") or lines[0].startswith("  or:")):
        usage.append(re.sub(r"^(Usage:|  or:) ", "", lines.pop(0)))
    rest = "\n".join(lines)
    first = re.search(r"^ {1,6}-", rest, re.M).start()
    behind = re.search(r"^for any corresponding short options\.$", rest, re.M)
    end = behind.end() if behind else len(rest)
    return usage, rest[:first].strip(), options(rest[first:end]), rest[end:].strip()


def prose(text):
    """Paragraphs; blocks that begin with blanks (examples, lists) as they are."""
    parts = []
    for paragraph in re.split(r"\n\s*\n", text):
        title, _, rest = paragraph.partition("\n")
        if title in ("Example:", "Examples:"):
            parts.append(f".SH EXAMPLES\n.nf\n{escape(rest)}\n.fi")
        elif re.search(r"^  ", paragraph, re.M):
            parts.append(f".PP\n.nf\n{escape(paragraph)}\n.fi")
        elif paragraph.strip():
            parts.append(f".PP\n{escape(paragraph)}")
    return "\n".join(parts)


def page(name, what, synopsis, body):
    head = f'.TH "{name.upper()}" 1 "" "{output("--version").strip()}" "crashpulse"\n'
    lines = "\n.br\n".join(escape(line) for line in synopsis)
    return f'{head}.SH NAME\n{escape(name)} \\- {escape(what)}\n.SH SYNOPSIS\n{lines}\n{body}\n'


def write_pages(table):
    man = folder / "man1"
    man.mkdir(parents=True, exist_ok=True)
    for old in man.glob("*.1"):
        old.unlink()
    for name, what in table:
        usage, before, option_list, behind = sections(output(name, "--help"))
        body = ".SH DESCRIPTION\n" + prose(before) + "\n.SH OPTIONS\n"
        body += "\n".join(f".TP\n{escape(names)}\n{escape(words)}" for names, words in option_list) + "\n"
        behind = re.sub(r"^Report bugs.*$", "", behind, flags=re.M)
        body += (".SH NOTES\n" if behind and not behind.startswith("Example") else "") + prose(behind)
        body += "\n.SH SEE ALSO\n" + escape("crashpulse(1)")
        (man / f"crashpulse-{name}.1").write_text(page(f"crashpulse-{name}", what, usage, body))
    help_text = output("--help")
    intro, _, rest = help_text.partition("\n\n")
    body = ".SH DESCRIPTION\n.PP\n" + escape("\n".join(intro.splitlines()[1:])) + "\n.SH COMMANDS\n"
    body += "\n".join(f".TP\n{escape(f'crashpulse-{name}(1)')}\n{escape(what)}" for name, what in table)
    body += "\n.SH NOTES\n" + prose(rest.split("\n\n", 1)[1])
    (man / "crashpulse.1").write_text(page("crashpulse", "virtual safety assessment at traffic scale",
                                           ["crashpulse COMMAND [ARGUMENT...]"], body))


def write_completion(table):
    """Commands first, then the command's long options; files for everything else."""
    cases = []
    for name, _ in table:
        words = []
        for names, _ in sections(output(name, "--help"))[2]:
            words += re.findall(r"--[a-z0-9-]+", names)
        words += [option for option, _ in GLOBAL]
        cases.append(f"    {name}) words=\"{' '.join(dict.fromkeys(words))}\" ;;")
    names = " ".join(name for name, _ in table)
    (folder / "crashpulse.bash").write_text(f"""# Completion of crashpulse for bash, made by make_manual.py.
_crashpulse()
{{
    local current="${{COMP_WORDS[COMP_CWORD]}}" previous="${{COMP_WORDS[COMP_CWORD-1]}}" words=""
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        COMPREPLY=($(compgen -W "{names} --help --version" -- "$current"))
        return
    fi
    case "$previous" in
    --format|-f) COMPREPLY=($(compgen -W "table json csv" -- "$current")); return ;;
    --log-format) COMPREPLY=($(compgen -W "text json" -- "$current")); return ;;
    esac
    case "${{COMP_WORDS[1]}}" in
{chr(10).join(cases)}
    esac
    case "$current" in
    -*) COMPREPLY=($(compgen -W "$words" -- "$current")) ;;
    *) compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- "$current")) ;;
    esac
}}
complete -F _crashpulse crashpulse
""")


table = commands()
write_pages(table)
write_completion(table)
