//! Enums as names.

/// Writes a value as its name: that of `name()`, or of the method after the colon. With the list of all values, it is read back, and the
/// schema lists the names.
///
/// ```
/// # use calibrant_core::json_name;
/// #[derive(Clone, Copy)]
/// enum Colour { Red, Green }
/// impl Colour {
///     const ALL: [Self; 2] = [Self::Red, Self::Green];
///     fn name(self) -> &'static str { match self { Self::Red => "red", Self::Green => "green" } }
/// }
/// json_name!(Colour, Colour::ALL);
/// ```
#[macro_export]
macro_rules! json_name {
    ($type:ty) => {
        $crate::json_name!($type: name);
    };
    ($type:ty, $all:expr) => {
        $crate::json_name!($type: name, $all);
    };
    ($type:ty: $name:ident) => {
        $crate::json_name!(@write $type, $name, ::schemars::json_schema!({ "type": "string" }));
    };
    ($type:ty: $name:ident, $all:expr) => {
        $crate::json_name!(@write $type, $name, {
            let names: ::std::vec::Vec<_> = $all.iter().map(|known| known.$name().to_string()).collect();
            ::schemars::json_schema!({ "type": "string", "enum": names })
        });

        impl<'de> ::serde::Deserialize<'de> for $type {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> ::core::result::Result<Self, D::Error> {
                let found = <::std::string::String as ::serde::Deserialize>::deserialize(deserializer)?;
                let named = |known: &$type| {
                    let name = known.$name().to_string();
                    name == found
                };
                $all.iter().copied().find(named).ok_or_else(|| {
                    let known: ::std::vec::Vec<_> = $all.iter().map(|known| format!("`{}`", known.$name())).collect();
                    ::serde::de::Error::custom(format!("`{found}` is none of {}", known.join(", ")))
                })
            }
        }
    };
    (@write $type:ty, $name:ident, $schema:expr) => {
        impl ::serde::Serialize for $type {
            fn serialize<S: ::serde::Serializer>(&self, serializer: S) -> ::core::result::Result<S::Ok, S::Error> {
                serializer.collect_str(&self.$name())
            }
        }

        impl ::schemars::JsonSchema for $type {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> ::std::borrow::Cow<'static, str> {
                $crate::json::type_name(stringify!($type)).into()
            }

            fn json_schema(_: &mut ::schemars::SchemaGenerator) -> ::schemars::Schema {
                $schema
            }
        }
    };
}
