// Configurations as text, through the schema's own description of them: a new field or a new kind
// of network shows up without a line here.  Defaults are shown too.
#include <flatbuffers/reflection.h>

#include <algorithm>

#include "models/cli/info.h"
#include "models/io/text.h"
#include "weights_bfbs_generated.h"
#include "weights_generated.h"

namespace gestus::cli {
namespace {

const reflection::Schema& Schema() {
  return *reflection::GetSchema(fb::WeightsFileBinarySchema::data());
}

/// The fields of a table in the order of their declaration.
std::vector<const reflection::Field*> Declared(const reflection::Object& object) {
  std::vector<const reflection::Field*> fields(object.fields()->begin(), object.fields()->end());
  std::sort(fields.begin(), fields.end(),
            [](const auto* a, const auto* b) { return a->id() < b->id(); });
  return fields;
}

std::string NameOf(const reflection::Enum& type, std::int64_t value) {
  for (const reflection::EnumVal* v : *type.values()) {
    if (v->value() == value) return v->name()->str();
  }
  return std::to_string(value);
}

std::string ScalarText(const flatbuffers::Table& table, const reflection::Field& field) {
  const int type = field.type()->index();
  switch (field.type()->base_type()) {
    case reflection::Bool:
      return flatbuffers::GetFieldI<std::uint8_t>(table, field) != 0 ? "true" : "false";
    case reflection::UByte: {
      const std::int64_t value = flatbuffers::GetFieldI<std::uint8_t>(table, field);
      return type < 0 ? std::to_string(value)
                      : NameOf(*Schema().enums()->Get(static_cast<std::uint32_t>(type)), value);
    }
    case reflection::Int:
      return std::to_string(flatbuffers::GetFieldI<std::int32_t>(table, field));
    case reflection::UInt:
      return std::to_string(flatbuffers::GetFieldI<std::uint32_t>(table, field));
    default:  // floats are the only other scalars that configurations have
      return Significant(double{flatbuffers::GetFieldF<float>(table, field)}, 3);
  }
}

void AddTable(const std::string& prefix, const flatbuffers::Table& table,
              const reflection::Object& object, Fields* fields);

void AddVector(const std::string& name, const flatbuffers::Table& table,
               const reflection::Field& field, Fields* fields) {
  using Tables = flatbuffers::Vector<flatbuffers::Offset<flatbuffers::Table>>;
  using Strings = flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>;
  if (field.type()->element() == reflection::Obj) {
    const auto* list = table.GetPointer<const Tables*>(field.offset());
    const auto& object =
        *Schema().objects()->Get(static_cast<std::uint32_t>(field.type()->index()));
    for (flatbuffers::uoffset_t i = 0; list != nullptr && i < list->size(); ++i)
      AddTable(name + "." + std::to_string(i) + ".", *list->Get(i), object, fields);
    return;
  }
  const auto* list = table.GetPointer<const Strings*>(field.offset());
  std::string text;
  for (flatbuffers::uoffset_t i = 0; list != nullptr && i < list->size(); ++i)
    text += (i == 0 ? "" : ", ") + list->Get(i)->str();
  if (list != nullptr) fields->emplace_back(name, text);
}

void AddTable(const std::string& prefix, const flatbuffers::Table& table,
              const reflection::Object& object, Fields* fields) {
  for (const reflection::Field* field : Declared(object)) {
    const std::string name = prefix + field->name()->str();
    switch (field->type()->base_type()) {
      case reflection::Obj: {
        const auto* inner = table.GetPointer<const flatbuffers::Table*>(field->offset());
        const auto index = static_cast<std::uint32_t>(field->type()->index());
        if (inner != nullptr) AddTable(name + ".", *inner, *Schema().objects()->Get(index), fields);
        break;
      }
      case reflection::String: {
        const auto* text = table.GetPointer<const flatbuffers::String*>(field->offset());
        if (text != nullptr) fields->emplace_back(name, text->str());
        break;
      }
      case reflection::Vector:
        AddVector(name, table, *field, fields);
        break;
      default:
        fields->emplace_back(name, ScalarText(table, *field));
    }
  }
}

}  // namespace

Fields ConfigFields(const fb::Network& network) {
  Fields fields;
  const std::string type = std::string("gestus.fb.") + fb::EnumNameConfig(network.config_type());
  const reflection::Object* object = Schema().objects()->LookupByKey(type.c_str());
  if (object != nullptr && network.config() != nullptr)
    AddTable("", *static_cast<const flatbuffers::Table*>(network.config()), *object, &fields);
  return fields;
}

}  // namespace gestus::cli
