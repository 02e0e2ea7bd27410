#compdef palpate
# Completion of palpate for zsh: the program itself says what may follow.
_palpate() {
  local word meaning
  local -a given plain shown open open_shown
  given=("${(@Q)words[2,CURRENT]}")
  given[-1]=${(Q)PREFIX}
  while IFS=$'\t' read -r word meaning; do
    case $word in
      :files) _files ;;
      :folders) _files -/ ;;
      *=) open+=("$word"); open_shown+=("$word  $meaning") ;;
      *) plain+=("$word"); shown+=("$word  $meaning") ;;
    esac
  done < <($words[1] complete "${given[@]}" 2>/dev/null)
  (( ! $#open )) || compadd -l -S '' -d open_shown -a open
  (( ! $#plain )) || compadd -l -d shown -a plain
}
if [[ $funcstack[1] == _palpate ]]; then _palpate "$@"; else compdef _palpate palpate; fi
