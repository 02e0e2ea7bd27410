// Finds the candidates for a word, and prints the scripts that ask for them.
#include "commands/complete.h"

#include <algorithm>

namespace palpate::commands {
namespace {

class Candidates {
 public:
  Candidates(std::string part, std::span<const FlatKey> keys, std::span<const std::string> examples)
      : part_(std::move(part)), keys_(keys), examples_(examples) {}

  void add(const std::string& word, const std::string& meaning) {
    if (word.starts_with(part_)) text_ += before_ + word + "\t" + meaning + "\n";
  }

  void value(const Argument& argument) {
    for (const std::string& word : argument.words()) add(word, "");
    if (!argument.words().empty()) return;
    const std::string& kind = argument.value;
    if (kind == "KEY=VALUE") {
      assignment();
    } else if (kind == "KEY") {
      for (const FlatKey& key : keys_) add(key.path, key.meaning);
      text_ += ":files\n";
    } else if (kind == "SCENARIO") {
      for (const std::string& example : examples_) add(example, "an installed example");
      text_ += ":files\n";
    } else if (kind == "FOLDER") {
      text_ += ":folders\n";
    } else if (kind == "FILE" || kind == "TEXT") {
      text_ += ":files\n";
    }
  }

  // What stands before a value on the same word, as `--out=`.
  void behind(std::size_t length) {
    before_ += part_.substr(0, length);
    part_.erase(0, length);
  }

  [[nodiscard]] const std::string& part() const { return part_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void assignment() {
    const auto sign = part_.find('=');
    if (sign == std::string::npos) {
      for (const FlatKey& key : keys_) add(key.path + "=", key.meaning);
      return;
    }
    const std::string path = part_.substr(0, sign);
    behind(sign + 1);
    for (const FlatKey& key : keys_)
      if (key.path == path)
        for (const Word& word : key.words) add(word.word, word.meaning);
  }

  std::string part_;
  std::string before_;
  std::string text_;
  std::span<const FlatKey> keys_;
  std::span<const std::string> examples_;
};

}  // namespace

std::string complete(const Command& program, const std::vector<std::string>& words,
                     std::span<const FlatKey> keys, std::span<const std::string> examples) {
  Candidates found(words.empty() ? "" : words.back(), keys, examples);
  const Command* verb = &program;
  std::vector<const Argument*> options;
  const auto enter = [&](const Command& command) {
    verb = &command;
    for (const Argument& option : command.options) options.push_back(&option);
  };
  const auto option_named = [&](const std::string& name) -> const Argument* {
    for (const Argument* option : options)
      if (std::find(option->names.begin(), option->names.end(), name) != option->names.end())
        return option;
    return nullptr;
  };
  enter(program);
  std::size_t operands = 0;
  const Argument* waiting = nullptr;  // an option whose value comes next
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (waiting != nullptr) {
      waiting = nullptr;
    } else if (words[i].starts_with("-")) {
      const Argument* option = option_named(words[i]);
      if (option != nullptr && !option->value.empty()) waiting = option;
    } else if (const Command* inner = verb->find(words[i])) {
      enter(*inner);
    } else {
      ++operands;
    }
  }
  const std::string part = found.part();
  if (waiting != nullptr) {
    found.value(*waiting);
  } else if (part.starts_with("-")) {
    const auto sign = part.find('=');
    const Argument* option =
        sign == std::string::npos ? nullptr : option_named(part.substr(0, sign));
    if (option != nullptr) {
      found.behind(sign + 1);
      found.value(*option);
    } else {
      for (const Argument* one : options)
        for (const std::string& name : one->names) found.add(name, one->meaning);
    }
  } else if (!verb->commands.empty()) {
    for (const Command& inner : verb->commands) found.add(inner.name, inner.meaning);
  } else if (!verb->operands.empty()) {
    const std::size_t last = verb->operands.size() - 1;
    const Argument& operand = verb->operands[std::min(operands, last)];
    if (operands <= last || operand.repeated) found.value(operand);
  }
  return found.text();
}

std::string completion_script(std::string_view shell) {
  if (shell == "bash")
    return R"(# Completion of palpate for bash: the program itself says what may follow.
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
)";
  if (shell == "zsh")
    return R"(#compdef palpate
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
)";
  return R"(# Completion of palpate for fish: the program itself says what may follow.
function __palpate_complete
    set -l words (commandline -opc) (commandline -ct)
    for line in ($words[1] complete $words[2..-1] 2>/dev/null)
        switch $line
            case ':files'
                __fish_complete_path (commandline -ct)
            case ':folders'
                __fish_complete_directories (commandline -ct)
            case '*'
                echo $line
        end
    end
end
complete -c palpate -f -a '(__palpate_complete)'
)";
}

}  // namespace palpate::commands
