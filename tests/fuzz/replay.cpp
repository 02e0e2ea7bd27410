// Runs kept inputs, and variations of them, through a fuzz target without a fuzzer's library:
//   palpate-fuzz TARGET INPUTS.hex VARIATIONS [WORDS.dict]
//                                              each input and so many variations of it
//   palpate-fuzz TARGET INPUTS.hex --unpack FOLDER
//                                              one file an input, as a fuzzer wants them
//   palpate-fuzz TARGET INPUTS.hex --pack FOLDER
//                                              adds the folder's files that are not in it, the
//                                              shortest first
// A crash is the failure.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "fuzzing.h"

namespace {

std::vector<std::string> read_inputs(const char* path) {
  std::ifstream stream(path);
  std::vector<std::string> inputs;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) continue;
    std::string input;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2)
      input += static_cast<char>(std::stoi(line.substr(i, 2), nullptr, 16));
    inputs.push_back(input);
  }
  return inputs;
}

// The words of a dictionary in libFuzzer's form: `"text"` with the escapes \\, \" and \xAB.
std::vector<std::string> read_words(const char* path) {
  std::ifstream stream(path);
  std::vector<std::string> words;
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with('"')) continue;
    std::string word;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      if (line[i] == '\\' && line[++i] == 'x') {
        word += static_cast<char>(std::stoi(line.substr(i + 1, 2), nullptr, 16));
        i += 2;
      } else {
        word += line[i];
      }
    }
    words.push_back(word);
  }
  return words;
}

std::string variation(std::string text, const std::vector<std::string>& words,
                      std::mt19937& random) {
  for (unsigned edits = 1 + random() % 4; edits > 0 && !text.empty(); --edits) {
    const std::size_t at = random() % text.size();
    switch (random() % (words.empty() ? 4 : 5)) {
      case 0: text[at] = static_cast<char>(random() % 256); break;
      case 1: text.erase(at, 1 + random() % 8); break;
      case 2: text.insert(at, text.substr(random() % text.size(), random() % 16)); break;
      case 3: text[at] = static_cast<char>(text[at] ^ (1 << random() % 8)); break;
      default: text.insert(at, words[random() % words.size()]); break;
    }
  }
  return text;
}

std::string hexadecimal(const std::string& input) {
  static const char digits[] = "0123456789abcdef";
  std::string text;
  for (const char c : input) {
    const auto byte = static_cast<unsigned char>(c);
    (text += digits[byte >> 4]) += digits[byte & 15];
  }
  return text;
}

void pack(const char* path, const std::vector<std::string>& kept, const char* folder) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(stream), {}};
    if (!input.empty() && std::find(kept.begin(), kept.end(), input) == kept.end())
      found.push_back(input);
  }
  std::sort(found.begin(), found.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  std::ofstream stream(path, std::ios::app);
  for (const std::string& input : found) stream << hexadecimal(input) << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  palpate::fuzz::Run* const target = argc > 3 ? palpate::fuzz::target(argv[1]) : nullptr;
  const auto inputs = argc > 3 ? read_inputs(argv[2]) : std::vector<std::string>();
  if (target == nullptr || inputs.empty()) {
    std::fprintf(
        stderr,
        "usage: %s TARGET INPUTS.hex VARIATIONS [WORDS.dict]|--unpack FOLDER|--pack FOLDER\n",
        argv[0]);
    return 2;
  }
  const std::string what = argv[3];
  const auto run = [&](const std::string& text) {
    target(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  if (what == "--pack" && argc > 4) {
    pack(argv[2], inputs, argv[4]);
    return 0;
  }
  if (what == "--unpack" && argc > 4) {
    std::filesystem::create_directories(argv[4]);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      std::ofstream(std::filesystem::path(argv[4]) / std::to_string(i), std::ios::binary)
          << inputs[i];
    return 0;
  }
  const auto words = argc > 4 ? read_words(argv[4]) : std::vector<std::string>();
  std::mt19937 random(1);
  long runs = 0;
  for (const std::string& input : inputs) {
    run(input);
    ++runs;
    for (int i = std::atoi(what.c_str()); i > 0; --i, ++runs) run(variation(input, words, random));
  }
  std::printf("%ld inputs\n", runs);
  return 0;
}
