// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/urdf/xml.h"

#include <cstring>

namespace hgrid {
namespace {

/// Searches the text `end` from index `at` on. Returns the index after `end`, or the length of the text if there is no
/// `end`.
std::size_t after(const std::string& xml, const char* end, std::size_t at) {
  const std::size_t found = xml.find(end, at);
  return found == std::string::npos ? xml.size() : found + std::strlen(end);
}

/// Returns the index after the tag that begins at index `at`. Quoted attributes may contain '>'.
std::size_t afterTag(const std::string& xml, std::size_t at) {
  char quote = 0;
  for (; at < xml.size(); ++at) {
    const char c = xml[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    }
  }
  return at;
}

/// Rejects text that is nested too deeply or has a DOCTYPE. This function uses no parser, because parsers are
/// recursive.
void scan(const std::string& xml, const DescriptionLimits& limits, const std::string& what) {
  std::size_t depth = 0;
  for (std::size_t at = xml.find('<'); at < xml.size(); at = xml.find('<', at)) {
    if (xml.compare(at, 4, "<!--") == 0) {
      at = after(xml, "-->", at + 4);
    } else if (xml.compare(at, 9, "<![CDATA[") == 0) {
      at = after(xml, "]]>", at);
    } else if (xml.compare(at, 2, "<?") == 0) {
      if (depth > 0) {
        throw Refusal(Code::unsupported, what + " has a processing instruction '" + printable(xml.substr(at, 16), 16) +
                                             "' at byte " + std::to_string(at) +
                                             "; inside the root element, this reader takes none");
      }
      at = after(xml, "?>", at);
    } else if (xml.compare(at, 2, "<!") == 0) {
      throw Refusal(Code::unsupported, what + " has a declaration '" + printable(xml.substr(at, 16), 16) +
                                           "' at byte " + std::to_string(at) +
                                           "; DOCTYPE and entities are not allowed");
    } else if (xml.compare(at, 2, "</") == 0) {
      at = after(xml, ">", at);
      if (depth > 0) --depth;
    } else {
      const std::size_t begin = at;
      at = afterTag(xml, at);
      const bool closes_itself = at >= 2 && xml[at - 2] == '/';
      if (!closes_itself && ++depth > limits.max_depth) {
        throw Refusal(Code::limit, what + " nests elements " + std::to_string(depth) + " levels deep at byte " +
                                       std::to_string(begin) + "; at most " + std::to_string(limits.max_depth) +
                                       " are allowed");
      }
    }
  }
}

}  // namespace

void parseXml(const std::string& xml, const DescriptionLimits& limits, const std::string& what, const char* root,
              tinyxml2::XMLDocument& document) {
  if (xml.size() > limits.max_bytes) {
    throw Refusal(Code::limit, what + " has " + std::to_string(xml.size()) + " bytes; at most " +
                                   std::to_string(limits.max_bytes) + " are allowed");
  }
  if (xml.find('\0') != std::string::npos) {
    throw Refusal(Code::parse,
                  what + " has a zero byte at byte " + std::to_string(xml.find('\0')) + "; XML must not contain one");
  }
  scan(xml, limits, what);
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    throw Refusal(Code::parse, what + " is not well-formed XML: " + document.ErrorName() + " in line " +
                                   std::to_string(document.ErrorLineNum()));
  }
  const tinyxml2::XMLElement* element = document.RootElement();
  if (element == nullptr || std::strcmp(element->Name(), root) != 0) {
    throw Refusal(Code::parse, what + " begins with <" + printable(element == nullptr ? "" : element->Name(), 48) +
                                   "> in line " + std::to_string(element == nullptr ? 1 : element->GetLineNum()) +
                                   "; its root element must be <" + root + ">");
  }
}

void checkXml(const std::string& xml, const DescriptionLimits& limits, const std::string& what) {
  tinyxml2::XMLDocument document;
  parseXml(xml, limits, what, "robot", document);
}

}  // namespace hgrid
