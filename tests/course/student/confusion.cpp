// Makes each mistake of the learner's engine and prints how it is named: `plumb_course_confusion [--without]
// [--built HOW] [--part K/N] [MISTAKE...]`. `--without` leaves the mistake itself out of what diagnoses know,
// `--built` is how the engine is built, as ", clipped". Prints one line a mistake, the first diagnosis and
// the others, and counts. The exit code is 1 if a mistake that is known is not named, or one is named
// falsely.
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "harness/course/course.h"
#include "harness/course/prediction.h"
#include "harness/course/student/student.h"

namespace plumb::course {
namespace {

struct Options {
  bool without = false;
  std::string built;
  std::size_t part = 0, parts = 1;
  std::set<std::string> chosen;
};

Options read(int count, char** arguments) {
  Options out;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--without") {
      out.without = true;
    } else if (argument == "--built" && i + 1 < count) {
      out.built = arguments[++i];
    } else if (argument == "--part" && i + 1 < count) {
      const std::string part = arguments[++i];
      out.part = std::strtoul(part.c_str(), nullptr, 10);
      out.parts = std::strtoul(part.c_str() + part.find('/') + 1, nullptr, 10);
    } else {
      out.chosen.insert(argument);
    }
  }
  return out;
}

struct Count {
  int named = 0, described = 0, unnamed = 0, harmless = 0, another = 0, later = 0;
};

void run(const Predictable& mistake, const Options& options, const std::vector<Chapter>& chapters,
         Count& count) {
  std::string first = "harmless", others;
  bool failed = false;
  const auto student = make_student(mistake.planted + options.built);
  examine(
      *student, {}, chapters,
      [&](const Outcome& outcome) {
        const Finding& finding = outcome.finding;
        if (finding.verdict != Verdict::Fail && finding.verdict != Verdict::Broken) return;
        const std::string name = finding.mistake.empty() ? "-" : finding.mistake;
        if (!failed) {
          failed = true;
          first = outcome.check->name + " " + name;
          const bool described =
              finding.mistake.empty() &&
              finding.says.find(std::string(" ") + mistake.name + ": ") != std::string::npos;
          if (name == mistake.name)
            ++count.named;
          else if (described)
            ++count.described, first += " (described)";
          else if (finding.mistake.empty())
            ++count.unnamed, first += " " + finding.says.substr(0, 200);
          else
            ++count.another, first += " (another) " + finding.says;
        } else if (!finding.mistake.empty() && finding.mistake != mistake.name) {
          ++count.later;
          others +=
              fmt::format("; {} {} {}", outcome.check->name, name, finding.computed ? "computed" : "seen");
        }
      },
      options.without ? mistake.planted : "");
  if (!failed) ++count.harmless;
  fmt::print("{} [{}]: {}{}\n", mistake.planted, mistake.name, first, others);
  std::fflush(stdout);
}

}  // namespace
}  // namespace plumb::course

int main(int count, char** arguments) {
  using namespace plumb::course;
  const Options options = read(count, arguments);
  const std::vector<Chapter> all = chapters();
  Count total;
  std::set<std::string> done;
  std::size_t at = 0;
  for (const Predictable& mistake : predictable_mistakes()) {
    if (!options.chosen.empty() && !options.chosen.contains(mistake.planted)) continue;
    if (!done.insert(std::string(mistake.planted) + mistake.chapters).second) continue;
    if (at++ % options.parts != options.part) continue;
    std::vector<Chapter> its;
    for (const Chapter& chapter : all)
      if (std::string(mistake.chapters).find(static_cast<char>('0' + chapter.number)) != std::string::npos)
        its.push_back(chapter);
    run(mistake, options, its, total);
  }
  fmt::print(
      "named {}, described with others {}, not named {}, another {}, harmless {}; other names later {}\n",
      total.named, total.described, total.unnamed, total.another, total.harmless, total.later);
  return total.another > 0 || (!options.without && total.unnamed > 0);
}
