"""What git runs for a diff of manifests, as shell: it must work, and lose nothing, where PICO's Python does not.

Both scripts stand in git's local configuration as a whole. Whatever fails in them, git's ordinary diff is printed.
"""

from __future__ import annotations

SUMMARY, ALONE = 40, 41
"""What the summary of `pico.history.diff.driver` ends with: lines follow, or are not wanted. Nothing else ends so."""

# Git calls it with 7 arguments: path, then file, id and mode of the old and of the new side; with 9 where the path
# changed, and with 1 where it is unmerged. It tells a driver neither its own options nor how a pager is fed, so they
# are read from the command line of git. The ordinary diff is made from two trees of this one file, held in a folder of
# their own: what git prints of them is, byte for byte, what it would have printed itself. Files that git does not keep
# (`git diff --no-index`) are compared as such.
_DIFF = r"""pico_diff() (
if test -n "$GIT_EXTERNAL_DIFF"; then sh -c "$GIT_EXTERNAL_DIFF \"\$@\"" sh "$@"; exit; fi
if test $# -lt 7; then printf '* Unmerged path %s\n' "$1"; exit 0; fi
set -f
IFS='
'
tty=false
if test -t 1; then tty=true; fi
color=$(git config --get-colorbool color.diff $tty)
given=
for word in $({ tr '\0' '\n' </proc/$PPID/cmdline || ps -o args= -p $PPID | tr ' ' '\n'; } 2>/dev/null); do
case $word in
--) break ;;
--color | --color=always) color=true given=$given$IFS$word ;;
--no-color | --color=never) color=false given=$given$IFS$word ;;
-U* | -[wbaW] | --unified=* | --ignore-* | --text | --function-context | --word-diff* | --color-words* | \
--color-moved* | --ws-error-highlight=* | --no-prefix | --src-prefix=* | --dst-prefix=* | --full-index | --abbrev=* | \
--minimal | --patience | --histogram | --diff-algorithm=* | --anchored=* | --no-indent-heuristic | \
--inter-hunk-context=* | --output-indicator-*) given=$given$IFS$word ;;
esac
done
said=$(git config pico.diff)
if test "$said" != lines && grep -qs 'apiVersion.*pico/' -- "$2" "$5"; then
said=$(PYTHON -P -m pico.history.diff.driver "$color" "$said" "$@" 2>/dev/null)
case $? in
SUMMARY) printf '%s\n\n' "$said" ;;
ALONE) printf '%s\n' "$said"; exit 0 ;;
esac
fi
side() {
id=$4
if test "$5" = .; then return 0; fi
case $id in
*[!0]*) ;;
*) if test "$5" = 120000; then how=--no-filters; else how=--path=$2; fi
id=$(git hash-object -w "$how" -- "$3" 2>/dev/null) || return 1 ;;
esac
printf '%s %s\t%s\0' "$5" "$id" "$2" | GIT_INDEX_FILE=$at/$1 git update-index -z --index-info
}
ordinary() {
case $1 in /* | ../*) return 1 ;; esac
case ${8-} in /* | ../*) return 1 ;; esac
case $3$6 in *[!0]*) ;; *) return 1 ;; esac
at=$(mktemp -d) && trap 'rm -rf "$at"' EXIT || return 1
objects=$(git rev-parse --path-format=absolute --git-path objects) || return 1
objects=$objects${GIT_ALTERNATE_OBJECT_DIRECTORIES:+:$GIT_ALTERNATE_OBJECT_DIRECTORIES}
export GIT_OBJECT_DIRECTORY="$at" GIT_ALTERNATE_OBJECT_DIRECTORIES="$objects"
renamed=
side old "$1" "$2" "$3" "$4" && side new "${8-$1}" "$5" "$6" "$7" || return 1
case ${9-} in
*'copy from'*) renamed=-C01$IFS--find-copies-harder; side new "$1" "$2" "$3" "$4" || return 1 ;;
?*) renamed=-M01 ;;
esac
old=$(GIT_INDEX_FILE=$at/old git write-tree --missing-ok) || return 1
new=$(GIT_INDEX_FILE=$at/new git write-tree --missing-ok) || return 1
git --no-pager diff --no-ext-diff --no-textconv $given $renamed "$old" "$new"
}
other=$(git config diff.external)
if test -n "$other"; then sh -c "$other \"\$@\"" sh "$@"; exit; fi
ordinary "$@" || git --no-pager diff --no-ext-diff --no-textconv --no-index $given -- "$2" "$5"
exit 0
); pico_diff"""

# One line out for each line in, so that `git blame`, which reads converted text, too, names the right ones: a line that
# holds a key is written with the address of what it is about, every other one as it is.
_ADDRESSES = r"""function depth(s) {
sub(/[ \t]#.*/, "", s); gsub(/"[^"]*"|\047[^\047]*\047/, "", s)
return gsub(/[\[{]/, "", s) - gsub(/[\]}]/, "", s)
}
BEGIN { below = -1 }
{
match($0, /^ */); at = RLENGTH; line = substr($0, at + 1)
if (flow > 0) { flow += depth(line); print; next }
if (line ~ /^#/ || line ~ /^[ \t\r]*$/ || (below >= 0 && at > below)) { print; next }
below = -1
if (line ~ /^-/) { if (line ~ /^---/) n = 0; else below = at; print; next }
if (at > 200) { print; next }
if (!match(line, /^[A-Za-z_][A-Za-z0-9_.\/-]*:/) || substr(line, RLENGTH + 1) !~ /^([ \t\r]|$)/) { print; next }
value = substr(line, RLENGTH + 1)
while (n > 0 && column[n] >= at) n--
column[++n] = at; name[n] = substr(line, 1, RLENGTH - 1)
address = name[1]
for (i = 2; i <= n; i++) address = (i == 2 && address == "components" ? "" : address ".") name[i]
print address ":" value
if (value ~ /^[ \t]+[|>]/) below = at
flow = depth(value)
}"""

_TEXT = r"""pico_text() {
if grep -q '^apiVersion:.*pico/' <"$1" && text=$(LC_ALL=C awk 'ADDRESSES' <"$1" 2>/dev/null && echo .); then
if test -n "$(tail -c 1 <"$1")"; then text=${text%?.}; else text=${text%.}; fi
printf '%s' "$text"
else
cat <"$1"
fi
}; pico_text"""


def diff_command(python: str) -> str:
    """Return the shell command for `diff.pico.command`; `python` is the quoted interpreter that has PICO."""
    return _DIFF.replace("PYTHON", python).replace("SUMMARY)", f"{SUMMARY})").replace("ALONE)", f"{ALONE})")


def text_command() -> str:
    """Return the shell command for `diff.pico.textconv`."""
    return _TEXT.replace("ADDRESSES", _ADDRESSES)
