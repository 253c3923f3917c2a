#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/agreement.h"
#include "harness/table.h"
#include "harness/text_file.h"

namespace plumb::harness {
namespace {

using Json = nlohmann::ordered_json;
using Ink = Style::Ink;

constexpr std::size_t kGroupsShown = 3;  // groups of a case that the text shows; JSON has all

std::string joined(const std::vector<std::string>& names, std::string_view between = ", ") {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : std::string(between)) + name;
  return out;
}

bool is_unanimous(const Agreement& one) {
  return one.dissents.empty() &&
         (one.ran() < 2 || (one.groups.size() == 1 && one.groups[0].size() == one.ran()));
}

/// Reasons in the order of their first use, numbered from 1.
class Reasons {
 public:
  std::size_t number_of(const std::string& reason) {
    const auto found = std::ranges::find(all, reason);
    if (found != all.end()) return static_cast<std::size_t>(found - all.begin()) + 1;
    all.push_back(reason);
    return all.size();
  }
  std::vector<std::string> all;
};

std::string dissent_text(const Dissent& dissent, Reasons& reasons) {
  const std::size_t number = reasons.number_of(dissent.reason);
  if (dissent.misses.empty()) return fmt::format("{} ({})", dissent.engine, number);
  const Miss& worst = dissent.misses.front();
  std::string out = fmt::format("{} {} {}, {}{}", dissent.engine, worst.check, figure(worst.value),
                                times_text(worst), std::isfinite(worst.times()) ? " its bound" : "");
  if (dissent.misses.size() > 1) out += fmt::format(" and {} more", dissent.misses.size() - 1);
  return out + fmt::format(" ({})", number);
}

std::string groups_text(const Agreement& one) {
  if (one.groups.empty()) return "none";
  if (one.groups.size() == 1 && one.groups[0].size() == one.ran()) return fmt::format("all {}", one.ran());
  std::string out;
  const std::size_t shown = std::min(kGroupsShown, one.groups.size());
  for (std::size_t i = 0; i < shown; ++i)
    out += fmt::format("{}{}", out.empty() ? "" : "; ", joined(one.groups[i]));
  if (shown < one.groups.size()) out += fmt::format("; {} other sets", one.groups.size() - shown);
  return out;
}

double number(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::string times_text(const Miss& miss) {
  const double times = miss.times();
  if (!std::isfinite(times)) return "beyond any bound";
  return times < 99.5 ? fmt::format("{:.2g} x", times) : figure(times) + " x";
}

std::string agreement_text(std::span<const Agreement> cases, AgreementDetail detail, const Style& style) {
  std::string out = style.paint("Which engines agree", Ink::Bold) + "\n";
  std::vector<std::string> unanimous;
  for (const Agreement& one : cases)
    if (is_unanimous(one) && one.ran() > 0) unanimous.push_back(fmt::format("{} ({})", one.label, one.ran()));
  if (!unanimous.empty())
    out +=
        "  " +
        style.paint(
            wrap(fmt::format(
                     "all engines that run the case agree with the truth and with each other in {} of {}: {}",
                     unanimous.size(), cases.size(), joined(unanimous)),
                 style.width - 2, 4),
            Ink::Green) +
        "\n";
  Reasons reasons;
  for (const Agreement& one : cases) {
    if (is_unanimous(one)) continue;
    std::vector<std::string> missed;
    for (const Dissent& dissent : one.dissents) missed.push_back(dissent_text(dissent, reasons));
    if (detail == AgreementDetail::Brief) {
      for (const Absence& absence : one.absent)
        if (absence.broke) missed.push_back(fmt::format("{} (no result)", absence.engine));
      out += "  " +
             wrap(fmt::format("{}: {} of {} agree with the truth{}{}", one.label, one.agree.size(), one.ran(),
                              missed.empty() ? "" : "; not ", joined(missed, "; ")),
                  style.width - 2, 4) +
             "\n";
      continue;
    }
    out += "  " + style.paint(one.label, Ink::Bold) + "\n";
    const auto line = [&](const std::string& text) { out += "    " + wrap(text, style.width - 4, 6) + "\n"; };
    line(fmt::format("agree with the truth: {}",
                     one.agree.empty()
                         ? "none"
                         : fmt::format("{} ({} of {})", joined(one.agree), one.agree.size(), one.ran())));
    if (!missed.empty()) line("not: " + joined(missed, "; "));
    if (one.ran() > 1) line("with each other: " + groups_text(one));
    for (const Absence& absence : one.absent)
      if (absence.broke) line(fmt::format("no result: {}: {}", absence.engine, absence.why));
  }
  for (std::size_t i = 0; i < reasons.all.size(); ++i)
    out += "  " +
           style.paint(wrap(fmt::format("({}) {}", i + 1, reasons.all[i]), style.width - 2, 6), Ink::Dim) +
           "\n";
  return out;
}

std::string agreement_json(const Agreement& one) {
  Json dissents = Json::array(), absent = Json::array();
  for (const Dissent& dissent : one.dissents) {
    Json misses = Json::array();
    for (const Miss& miss : dissent.misses)
      misses.push_back({{"check", miss.check},
                        {"value", miss.value},
                        {"bound", miss.bound},
                        {"times", std::isfinite(miss.times()) ? Json(miss.times()) : Json(nullptr)}});
    dissents.push_back({{"engine", dissent.engine}, {"misses", misses}, {"reason", dissent.reason}});
  }
  for (const Absence& absence : one.absent)
    absent.push_back({{"engine", absence.engine}, {"why", absence.why}, {"broke", absence.broke}});
  const Json json{{"label", one.label}, {"truth", one.truth},   {"versions", one.versions},
                  {"agree", one.agree}, {"dissents", dissents}, {"groups", one.groups},
                  {"absent", absent}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Agreement agreement_from_json(std::string_view text) {
  try {
    const Json json = Json::parse(text);
    Agreement one{.label = json.at("label"),
                  .truth = json.at("truth"),
                  .versions = json.at("versions").get<std::vector<std::string>>(),
                  .agree = json.at("agree").get<std::vector<std::string>>(),
                  .dissents = {},
                  .absent = {},
                  .groups = json.at("groups").get<std::vector<std::vector<std::string>>>()};
    for (const Json& dissent : json.at("dissents")) {
      Dissent& out = one.dissents.emplace_back();
      out.engine = dissent.at("engine");
      for (const Json& miss : dissent.at("misses"))
        out.misses.push_back({miss.at("check"), number(miss.at("value")), number(miss.at("bound"))});
      out.reason = dissent.at("reason");
    }
    for (const Json& absence : json.at("absent"))
      one.absent.push_back({absence.at("engine"), absence.at("why"), absence.at("broke")});
    return one;
  } catch (const nlohmann::json::exception& error) {
    throw Error(Error::Kind::Syntax, "an agreement", "", std::string(text.substr(0, 80)),
                fmt::format("cannot be read: {}", error.what()));
  }
}

std::vector<Agreement> read_agreements(const std::string& path) {
  std::vector<Agreement> out;
  std::istringstream lines(read_text(path, "`plumb agreement --format json` writes one"));
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) out.push_back(agreement_from_json(line));
  return out;
}

std::string agreement_csv(std::span<const Agreement> cases) {
  std::string out = "label,engine,outcome,check,value,bound,times,agrees_with,reason\n";
  for (const Agreement& one : cases) {
    const auto line = [&](const std::string& engine, std::string_view outcome, const Miss* miss,
                          const std::string& reason) {
      out += fmt::format("{},{},{},", csv_field(one.label), csv_field(engine), outcome);
      out += miss == nullptr ? ",,,"
                             : fmt::format("{},{},{},{}", csv_field(miss->check), miss->value, miss->bound,
                                           miss->times());
      out += "," + csv_field(joined(one.partners(engine), " ")) + "," + csv_field(reason) + "\n";
    };
    for (const std::string& engine : one.agree) line(engine, "agrees", nullptr, "");
    for (const Dissent& dissent : one.dissents) {
      if (dissent.misses.empty()) line(dissent.engine, "diverged", nullptr, dissent.reason);
      for (const Miss& miss : dissent.misses) line(dissent.engine, "misses", &miss, dissent.reason);
    }
    for (const Absence& absence : one.absent)
      line(absence.engine, absence.broke ? "broke" : "unsupported", nullptr, absence.why);
  }
  return out;
}

}  // namespace plumb::harness
