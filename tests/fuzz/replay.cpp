// Runs kept inputs, and variations of them, through a fuzz target without a fuzzer's library:
// PROGRAM FOLDER [VARIATIONS]. A crash is the failure.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s FOLDER [VARIATIONS]\n", argv[0]);
    return 2;
  }
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  const int variations = argc > 2 ? std::atoi(argv[2]) : 0;
  std::mt19937 random(1);
  long runs = 0;
  for (const auto& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    const std::string kept{std::istreambuf_iterator<char>(stream), {}};
    const auto run = [&](const std::string& text) {
      LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
      ++runs;
    };
    run(kept);
    for (int i = 0; i < variations; ++i) {
      std::string text = kept;
      for (unsigned edits = 1 + random() % 4; edits > 0 && !text.empty(); --edits) {
        const std::size_t at = random() % text.size();
        switch (random() % 4) {
          case 0: text[at] = static_cast<char>(random() % 256); break;
          case 1: text.erase(at, 1 + random() % 8); break;
          case 2: text.insert(at, text.substr(random() % text.size(), random() % 16)); break;
          default: text[at] = static_cast<char>(text[at] ^ (1 << random() % 8)); break;
        }
      }
      run(text);
    }
  }
  std::printf("%ld inputs\n", runs);
  return paths.empty() ? 1 : 0;
}
