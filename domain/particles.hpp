#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "domain/column_storage.hpp"
#include "domain/fields.hpp"

namespace talus {

/// One field's values for all particles of a set: one contiguous array a component.
struct Column {
    const FieldInfo* info;
    std::vector<StaggeredVector<std::byte>> components;

    std::size_t value_size() const { return size_of(info->type); }
};

/// A named structure of arrays. Own particles come first, in (cell, id) order after a sort; copies of
/// neighbours' particles (the halo) follow, for the columns whose reach is `halo`.
class ParticleSet {
  public:
    ParticleSet(std::string name, int dimension);

    const std::string& name() const { return name_; }
    int dimension() const { return dimension_; }
    std::size_t size() const { return size_; }            ///< own particles
    std::size_t halo_size() const { return halo_size_; }  ///< copies
    std::size_t size_with_halo() const { return size_ + halo_size_; }

    /// Makes sure the field exists; new values are zero. `profile_size`: number of values of a profile.
    void add(const FieldInfo& info, int profile_size = 0);
    bool has(const FieldInfo& info) const { return find(info) != nullptr; }

    /// Values of one component, own particles then halo. Throws std::logic_error if the field was not added.
    template <class T>
    T* data(const Field<T>& field, int component = 0) {
        return reinterpret_cast<T*>(column(field).components[static_cast<std::size_t>(component)].data());
    }
    template <class T>
    const T* data(const Field<T>& field, int component = 0) const {
        return reinterpret_cast<const T*>(
            column(field).components[static_cast<std::size_t>(component)].data());
    }
    /// Own particles' values of one component.
    template <class T>
    std::span<T> own(const Field<T>& field, int component = 0) {
        return {data(field, component), size_};
    }
    template <class T>
    std::span<const T> own(const Field<T>& field, int component = 0) const {
        return {data(field, component), size_};
    }

    std::vector<Column>& columns() { return columns_; }
    const std::vector<Column>& columns() const { return columns_; }
    Column& column(const FieldInfo& info);
    const Column& column(const FieldInfo& info) const;

    /// Changes the number of own particles; drops the halo. New values are zero.
    void resize(std::size_t size);
    /// Makes room for `halo_size` copies after the own particles.
    void set_halo_size(std::size_t halo_size);
    /// Own particle k becomes what order[k] was (order may be shorter than size()); drops the halo. Only
    /// state columns keep their values.
    void reorder(std::span<const std::uint32_t> order);

    /// Bytes held for one own particle, all columns.
    std::size_t bytes_per_particle() const;

  private:
    const Column* find(const FieldInfo& info) const;

    std::string name_;
    int dimension_;
    std::size_t size_ = 0;
    std::size_t halo_size_ = 0;
    std::vector<Column> columns_;
    StaggeredVector<std::byte> reorder_buffer_;
};

/// Id of the first own particle with a rate or a state that is not finite, and the field's name; nullptr if
/// none.
struct NotFinite {
    std::uint64_t id;
    const FieldInfo* field;
};
NotFinite find_not_finite(const ParticleSet& particles);

}  // namespace talus
