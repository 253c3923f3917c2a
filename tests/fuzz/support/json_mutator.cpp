// Changes JSON in other ways than byte by byte: numbers become extreme, members and elements are left out,
// doubled and put elsewhere, so that most inputs are still JSON and get past the parser. Texts that are no
// JSON as a whole are taken line by line. libFuzzer calls this where it is linked in.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace plumb::fuzz {
namespace {

using Json = nlohmann::ordered_json;

class Random {
 public:
  explicit Random(unsigned seed) : state_(seed) {}
  std::size_t below(std::size_t count) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(state_ >> 33) % count;
  }
  template <class T>
  const T& of(const std::vector<T>& all) {
    return all[below(all.size())];
  }

 private:
  std::uint64_t state_;
};

const std::vector<double> kNumbers{0,
                                   -0.0,
                                   1,
                                   -1,
                                   2,
                                   0.5,
                                   1e-6,
                                   1e-12,
                                   1e-300,
                                   5e-324,
                                   1e3,
                                   1e6,
                                   1e12,
                                   -1e12,
                                   1e20,
                                   1e38,
                                   1e300,
                                   -1e300,
                                   3.14159265358979,
                                   1e-3,
                                   100,
                                   65536,
                                   1e7,
                                   0.1,
                                   2147483647.0,
                                   2147483648.0,
                                   4294967295.0,
                                   9e15};

void collect(Json& node, std::vector<Json*>& all) {
  all.push_back(&node);
  if (!node.is_structured()) return;
  for (Json& item : node) collect(item, all);
}

void change_number(Json& node, Random& random) {
  const double value = node.get<double>();
  switch (random.below(4)) {
    case 0:
      node = -value;
      return;
    case 1:
      node = value * (0.25 + 0.25 * static_cast<double>(random.below(12)));
      return;
    case 2:
      node = value + 0.1 * static_cast<double>(random.below(20)) - 1;
      return;
    default:
      node = random.of(kNumbers);
  }
}

void change_text(Json& node, const std::vector<Json*>& all, Random& random) {
  const Json& other = *random.of(all);
  if (other.is_string() && random.below(3) > 0) {
    node = other;
    return;
  }
  std::string text = node.get<std::string>();
  const std::size_t size = text.size();
  text.resize(size + 8);
  text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
  node = text;
}

// Elements of a list are doubled, left out, or change places; what has a name gets another one.
void change_list(Json& node, Random& random) {
  const std::size_t at = random.below(node.size()), other = random.below(node.size());
  const auto place = node.begin() + static_cast<std::ptrdiff_t>(at);
  if (random.below(3) == 0) {
    node.erase(place);
  } else if (random.below(3) == 0) {
    std::swap(node[at], node[other]);
  } else {
    Json copy = node[at];
    if (copy.is_object() && copy.contains("name") && copy["name"].is_string())
      copy["name"] = copy["name"].get<std::string>() + static_cast<char>('a' + random.below(26));
    node.push_back(std::move(copy));
  }
}

void change_object(Json& node, const std::vector<Json*>& all, Random& random) {
  auto place = node.begin();
  std::advance(place, static_cast<std::ptrdiff_t>(random.below(node.size())));
  const std::string key = place.key();
  if (random.below(2) == 0) {
    node.erase(key);
    return;
  }
  Json& other = *random.of(all);  // may be the node itself, which is then not an object of others
  if (!other.is_object() || other.empty() || &other == &node) return;
  auto from = other.begin();
  std::advance(from, static_cast<std::ptrdiff_t>(random.below(other.size())));
  const std::string name = from.key();
  const Json value = from.value();
  node[name] = value;
}

void change(Json& root, Random& random) {
  std::vector<Json*> all;
  collect(root, all);
  Json& node = *all[random.below(all.size())];
  if (random.below(12) == 0) {
    const Json other = *random.of(all);  // a copy: it may lie within
    node = random.below(4) > 0 ? other : Json{};
  } else if (node.is_number()) {
    change_number(node, random);
  } else if (node.is_string()) {
    change_text(node, all, random);
  } else if (node.is_boolean()) {
    node = !node.get<bool>();
  } else if (node.is_array() && !node.empty()) {
    change_list(node, random);
  } else if (node.is_object() && !node.empty()) {
    change_object(node, all, random);
  } else {
    node = random.of(kNumbers);
  }
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, nlohmann::detail::error_handler_t::replace);
}

/// The same text with one JSON value in it changed; empty where none is found.
std::string changed(std::string_view text, Random& random) {
  const auto change_one = [&](std::string_view one) -> std::string {
    Json json = Json::parse(one, nullptr, false);
    if (json.is_discarded()) return "";
    for (std::size_t i = 1 + random.below(4); i > 0; --i) change(json, random);
    return text_of(json);
  };
  if (std::string whole = change_one(text); !whole.empty()) return whole;
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::size_t which = random.below(lines.size());
  const std::string line = change_one(lines[which]);
  if (line.empty()) return "";
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i > 0) out += '\n';
    out += i == which ? std::string_view(line) : lines[i];
    if (i == which && random.below(8) == 0) out += '\n' + line;
  }
  return out;
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  plumb::fuzz::Random random(seed);
  if (random.below(4) > 0) {
    const std::string out = plumb::fuzz::changed({reinterpret_cast<const char*>(data), size}, random);
    if (!out.empty() && out.size() <= max_size) {
      std::memcpy(data, out.data(), out.size());
      return out.size();
    }
  }
  return LLVMFuzzerMutate(data, size, max_size);
}
