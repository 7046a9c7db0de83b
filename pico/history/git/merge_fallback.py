r"""The merge of lines where the driver is missing or killed, as shell: it needs git and awk, and no Python.

Git's own merge of lines takes equal lines for the same ones, whatever part they belong to: where one side puts a new
component before an edited `yaw: 0`, the edit of the other side can end up in the new component, without a word. So
every line is merged together with the keys that it stands under, which are taken off again afterwards.
"""

from __future__ import annotations

# A comment or an empty line stands under the keys that are left of it, and closes none of them.
_TAG = r"""{ match($0, /^ */); at = RLENGTH; body = substr($0, at + 1); m = n
while (m > 0 && column[m] >= at) m--
if (body !~ /^(#|[ \t\r]*$)/) n = m
path = ""; for (i = 1; i <= m; i++) path = path name[i] "."
print path "\037" $0
if (match(body, /^[A-Za-z_][A-Za-z0-9_.\/-]*:/)) { column[++n] = at; name[n] = substr(body, 1, RLENGTH - 1) } }"""
_UNTAG = r"""{ sub(/^[^\037]*\037/, ""); print }"""
_SCRIPT = r"""tag() { test -z "$(tail -c 1 "$1")" && LC_ALL=C awk 'TAG' "$1" > "$2"; };
same() { LC_ALL=C awk 'UNTAG' "$1" | cmp -s - "$2"; };
if grep -qs 'apiVersion.*pico/' %A && tag %A %A.a && tag %O %A.o && tag %B %A.b
&& same %A.a %A && same %A.o %O && same %A.b %B; then
git merge-file -p --marker-size=%L -L ours -L base -L theirs %A.a %A.o %A.b > %A.m; s=$?;
if test $s -lt 128 && LC_ALL=C awk 'UNTAG' %A.m > %A.pico && mv -f %A.pico %A; then
rm -f %A.a %A.o %A.b %A.m; test $s -eq 0; exit; fi; fi;
rm -f %A.a %A.o %A.b %A.m %A.pico; git merge-file --marker-size=%L -L ours -L base -L theirs %A %O %B"""


def merge_lines() -> str:
    """Return the commands for `merge.pico.driver`, in one line, with git's placeholders (%A ours, %O base, %B theirs,
    %L the length of the markers); they end with 0 where the merge is clean and leave markers otherwise."""
    tag = "; ".join(_TAG.splitlines())
    return " ".join(_SCRIPT.splitlines()).replace("UNTAG", _UNTAG).replace("TAG", tag)
