#include "harness/report/report_data.h"

#include "harness/report/markup.h"
#include "harness/report/page_parts.h"

namespace plumb::harness::report {
std::string report_page(const std::string& title, const std::string& data) {
  std::string out = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  out += "<link rel=\"icon\" href=\"data:,\">\n";
  out += "<title>plumb: " + escaped(title) + "</title>\n<style>\n" + std::string(kStyle) +
         "</style>\n</head>\n<body>\n";
  out += kBody;
  out += "<script type=\"application/json\" id=\"data\">" + data + "</script>\n";
  out += "<script>\n";
  for (const std::string_view piece : kLibrary) out += piece;
  out += "</script>\n<script>\n(() => {\n\"use strict\";\n";
  for (const std::string_view script : kScripts) out += script;
  return out + "})();\n</script>\n</body>\n</html>\n";
}

}  // namespace plumb::harness::report
