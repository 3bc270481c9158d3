#!/bin/sh
# The documentation against what it speaks of: docs.sh KILN ROOT fails when docs/cli.md does not quote the program's own
# list of options, when a file that is mentioned does not exist, or when a link leads nowhere. `--update` behind them
# writes the list of options anew.
# shellcheck disable=SC2013,SC2016 # names without blanks; regular expressions
set -eu
kiln=$1
cd "$2"
status=0

begin='<!-- begin: kiln render --help -->'
quote() {
  awk -v begin="$begin" '$0 == begin { skip = 1; print; print "```"; while ((getline line < "-") > 0) print line; print "```" }
    $0 == "<!-- end -->" { skip = 0 } !skip' docs/cli.md
}
quoted=$("$kiln" render --help | quote; echo x)
if [ "${3-}" = --update ]; then
  printf '%s' "${quoted%x}" >docs/cli.md
elif [ "$quoted" != "$(cat docs/cli.md; echo x)" ]; then
  echo "docs/cli.md does not quote 'kiln render --help': run tests/docs/docs.sh KILN ROOT --update"
  status=1
fi

for page in README.md docs/*.md; do
  folder=$(dirname "$page")
  for name in $(grep -oE '\]\([^)#:]+\)' "$page" | sed 's/^](//; s/)$//'); do
    [ -e "$folder/$name" ] || { echo "$page: links to $name, which does not exist"; status=1; }
  done
  for name in $(grep -oE '`[a-zA-Z_.]+/[a-zA-Z0-9_./]+`' "$page" | tr -d '`' | grep -vE '^(build|out|\.\.)/'); do
    [ -e "$name" ] || { echo "$page: speaks of $name, which does not exist"; status=1; }
  done
done
exit "$status"
