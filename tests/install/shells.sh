#!/usr/bin/env bash
# Completion in the shells themselves: shells.sh PALPATE. What stands outside a line that is being edited
# (compadd of zsh, compopt of bash) is replaced; everything else is the script that users get.
set -euo pipefail
palpate=$(readlink -f "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
mkdir bin plans
ln -s "$palpate" bin/palpate
export PATH=$scratch/bin:$PATH HOME=$scratch LC_ALL=C.UTF-8
touch own.toml
for shell in bash zsh fish; do palpate completion $shell >completion.$shell; done

in_bash() {
  bash --norc -c 'source completion.bash; compopt() { :; }; complete -p palpate >&2
    COMP_LINE=$1; COMP_POINT=${#1}; _palpate palpate; printf "%s\n" "${COMPREPLY[@]}"' - "$1" 2>/dev/null
}
in_zsh() {
  zsh -f -c 'compdef() { :; }; _files() { print -l own.toml plans }; compadd() { print -rl -- ${(P)@[-1]} }
    source ./completion.zsh; words=(${(z)1}); [[ $1 == *" " ]] && words+=(""); CURRENT=$#words; PREFIX=$words[-1]
    _palpate' - "$1"
}
in_fish() {
  fish --no-config -c 'source completion.fish; complete -C $argv[1]' "$1" | cut -f 1
}

faults=0
# expect LINE WORD...: each word is offered for the line in all shells. What bash replaces is the part
# behind the last `=` of a word.
expect() {
  local line=$1 shell word offered
  shift
  for shell in bash zsh fish; do
    offered=$("in_$shell" "$line")
    for word in "$@"; do
      [[ $shell == bash && $word == *=?* ]] && word=${word##*=}
      if ! grep -qxF -e "$word" <<<"$offered"; then
        echo "$shell: \`$line\` is not completed with \`$word\`, but with: ${offered//$'\n'/ }"
        faults=$((faults + 1))
      fi
    done
  done
}
expect 'palpate ' run explain sweep help new
expect 'palpate ru' run
expect 'palpate sweep ' plan run merge
expect 'palpate run --dr' --dry-run
expect 'palpate run ' own.toml
expect 'palpate run own.toml --set contact.coup' contact.coupling=
expect 'palpate run own.toml --set contact.coupling=' contact.coupling=one_way contact.coupling=resolved
expect 'palpate run own.toml --set step.1.kind=ind' step.1.kind=indent
expect 'palpate explain finger.rad' finger.radius
expect 'palpate fit own.csv --model pow' power
expect 'palpate fit own.csv --baseline ' none offset tilt
expect 'palpate new ' press organ live
expect 'palpate completion ' bash zsh fish
for shell in bash zsh fish; do
  if [[ $("in_$shell" 'palpate run own.toml --set contact.coupling=one' | wc -l) != 1 ]]; then
    echo "$shell: offers more than the one word that begins so"
    faults=$((faults + 1))
  fi
done
((faults == 0)) && echo "completion works in bash, zsh and fish"
