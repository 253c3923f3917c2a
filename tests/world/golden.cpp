#include "tests/world/golden.h"

#include <gtest/gtest.h>

#include <fstream>
#include <ios>
#include <map>
#include <sstream>

namespace plumb::test {
namespace {

std::map<std::string, std::uint64_t> read_golden() {
  std::map<std::string, std::uint64_t> golden;
  std::ifstream file(PLUMB_GOLDEN_HASHES);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    std::string name;
    std::uint64_t hash = 0;
    if (words >> name >> std::hex >> hash) golden[name] = hash;
  }
  return golden;
}

}  // namespace

// The line that it prints is what golden.py reads.
void expect_golden(const std::string& name, std::uint64_t hash) {
  static const std::map<std::string, std::uint64_t> golden = read_golden();
  const auto found = golden.find(name);
  if (found != golden.end() && found->second == hash) return;
  ADD_FAILURE() << "golden hash: " << name << " 0x" << std::hex << hash;
}

}  // namespace plumb::test
