#include "src/flow/contact_set.hpp"

#include <algorithm>

#include "domain/grain_fields.hpp"
#include "physics/dem/contact_record.hpp"

namespace talus {

ParticleSet contact_set(std::vector<dem::LoadedContact> contacts, const ParticleSet& grains) {
    const std::uint64_t* id = grains.data(field::copied_id);
    std::erase_if(contacts, [&](const dem::LoadedContact& one) { return one.first >= grains.size(); });
    const auto second_id = [&](const dem::LoadedContact& one) {
        return one.at_wall ? dem::wall_key(one.second, one.place) : id[one.second];
    };
    std::sort(contacts.begin(), contacts.end(),
              [&](const dem::LoadedContact& a, const dem::LoadedContact& b) {
                  return id[a.first] != id[b.first] ? id[a.first] < id[b.first] : second_id(a) < second_id(b);
              });
    ParticleSet set("contacts", 3);
    for (const SnapshotField& wanted : contact_fields()) set.add(*wanted.field);
    set.resize(contacts.size());
    std::uint64_t rank = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
        const dem::LoadedContact& contact = contacts[k];
        rank = k > 0 && contact.first == contacts[k - 1].first ? rank + 1 : 0;
        set.data(field::id)[k] = dem::pair_row_id(id[contact.first], rank);
        set.data(field::first_id)[k] = id[contact.first];
        set.data(field::second_id)[k] = second_id(contact);
        set.data(field::overlap)[k] = contact.overlap;
        const auto put = [&](const Field<double>& field, const dem::Vector3<>& v) {
            set.data(field, 0)[k] = v.x;
            set.data(field, 1)[k] = v.y;
            set.data(field, 2)[k] = v.z;
        };
        put(field::position, contact.point);
        put(field::normal, contact.normal);
        put(field::contact_force, contact.load.force);
    }
    return set;
}

std::vector<SnapshotField> contact_fields() {
    std::vector<SnapshotField> fields;
    for (const FieldInfo* info : std::initializer_list<const FieldInfo*>{
             &field::first_id, &field::second_id, &field::normal, &field::contact_force, &field::overlap})
        fields.push_back({.field = info});
    return fields;
}

}  // namespace talus
