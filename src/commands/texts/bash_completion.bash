# Completion of palpate for bash: the program itself says what may follow.
_palpate() {
  local line=${COMP_LINE:0:COMP_POINT} word part before
  local -a words names
  # Bash splits words at `=` and `:` too; the program is given those of the line.
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=("")
  part=${words[-1]}
  before=${part%"${part##*[=:]}"}
  COMPREPLY=()
  while IFS=$'\t' read -r word _; do
    case $word in
      :files) compopt -o filenames; mapfile -t names < <(compgen -f -- "${part#"$before"}") ;;
      :folders) compopt -o filenames; mapfile -t names < <(compgen -d -- "${part#"$before"}") ;;
      *) names=("${word#"$before"}"); [[ $word == *= ]] && compopt -o nospace ;;
    esac
    COMPREPLY+=("${names[@]}")
  done < <("$1" complete "${words[@]:1}" 2>/dev/null)
}
complete -F _palpate palpate
