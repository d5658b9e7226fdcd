// Whether markup is well-formed: elements closed in the order in which they were opened, attributes
// quoted and once each, references that end. Enough of XML for the SVG and HTML that we write.
#pragma once

#include <string>
#include <vector>

namespace tureen::test {

struct Markup {
  std::string defect;                    // what is wrong first, and where; empty where nothing is
  std::vector<std::string> elements;     // names in the order of their beginnings
  std::vector<std::string> links;        // values of href, src, url(..) and @import
  std::vector<std::string> identifiers;  // values of id
  std::string text;                      // between the tags, references not resolved
};

Markup check_markup(const std::string& document);

}  // namespace tureen::test
