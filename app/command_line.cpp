#include "app/command_line.h"

#include <fmt/format.h>

#include "app/usage.h"

namespace plumb::app {

std::vector<std::string> split_command(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  bool open = false;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0 ? c == quote : c == '\'' || c == '"') {
      quote = quote != 0 ? char{0} : c;
      open = true;
    } else if (quote == 0 && (c == ' ' || c == '\t')) {
      if (open) words.push_back(word);
      word.clear();
      open = false;
    } else {
      word += c;
      open = true;
    }
  }
  if (quote != 0) throw UsageError(fmt::format("the command {} has a quote that is not closed", text));
  if (open) words.push_back(word);
  return words;
}

}  // namespace plumb::app
