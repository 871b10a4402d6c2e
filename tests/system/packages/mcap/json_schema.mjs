// As much of JSON Schema as Tether's schemas use. An unknown keyword is an error, so that a schema never says more than
// is checked.

const ANNOTATIONS = new Set(["title", "description", "$comment", "contentEncoding"]);

const TYPES = {
  object: (v) => v !== null && typeof v === "object" && !Array.isArray(v),
  array: Array.isArray,
  string: (v) => typeof v === "string",
  boolean: (v) => typeof v === "boolean",
  number: (v) => typeof v === "number",
  integer: (v) => Number.isInteger(v),
  null: (v) => v === null,
};

const KEYWORDS = {
  type: (types, value, path) => {
    const names = [types].flat();
    return names.some((name) => TYPES[name]?.(value)) ? [] : [`${path} is no ${names.join(" or ")}`];
  },
  enum: (values, value, path) => (values.includes(value) ? [] : [`${path} is none of ${values.join(", ")}`]),
  minimum: (least, value, path) => (typeof value === "number" && value < least ? [`${path} is below ${least}`] : []),
  maximum: (most, value, path) => (typeof value === "number" && value > most ? [`${path} is above ${most}`] : []),
  minItems: (least, value, path) => (Array.isArray(value) && value.length < least ? [`${path} has less than ${least} items`] : []),
  maxItems: (most, value, path) => (Array.isArray(value) && value.length > most ? [`${path} has more than ${most} items`] : []),
  items: (schema, value, path) => (Array.isArray(value) ? value.flatMap((item, i) => schemaErrors(schema, item, `${path}[${i}]`)) : []),
  required: (names, value, path) =>
    TYPES.object(value) ? names.filter((name) => !(name in value)).map((name) => `${path}.${name} is missing`) : [],
  properties: (schemas, value, path) =>
    TYPES.object(value) ? Object.entries(schemas).flatMap(([name, schema]) => (name in value ? schemaErrors(schema, value[name], `${path}.${name}`) : [])) : [],
};

/** What is wrong with `value` under `schema`, a text each; none if nothing is. */
export function schemaErrors(schema, value, path = "message") {
  return Object.entries(schema).flatMap(([keyword, argument]) => {
    if (ANNOTATIONS.has(keyword)) return [];
    const check = KEYWORDS[keyword];
    return check ? check(argument, value, path) : [`schema keyword ${keyword} is not known`];
  });
}
