// Tables that a press on a heading sorts.

/// `columns`: [{name, number, text(row), value(row) to sort by, mark(row) a class, wide}].
function table(columns, rows, rowClass = () => "") {
  const body = make("tbody");
  let by = null, down = false;
  const fillBody = () => {
    const sorted = [...rows];
    if (by) {
      const value = by.value ?? by.text;
      const missing = (v) => v === null || v === undefined || Number.isNaN(v);
      sorted.sort((a, b) => {
        const [p, q] = [value(a), value(b)];
        if (missing(p) || missing(q)) return missing(p) - missing(q);
        const order = typeof p === "number" ? p - q : String(p).localeCompare(String(q), "en", {numeric: true});
        return down ? -order : order;
      });
    }
    body.replaceChildren(...sorted.map((row) => make("tr", {class: rowClass(row) || undefined},
      ...columns.map((column) => {
        const content = column.text(row);
        const names = [column.number && "number", column.wide && "wide", column.mark?.(row)].filter(Boolean).join(" ");
        const cell = make("td", {class: names || undefined});
        content instanceof Node ? cell.append(content) : (cell.textContent = content);
        return cell;
      }))));
  };
  const heads = columns.map((column) => {
    const head = make("th", {scope: "col", class: column.number ? "number" : undefined});
    head.append(make("button", {type: "button", text: column.name, click: () => {
      down = by === column ? !down : Boolean(column.number);
      by = column;
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      fillBody();
    }}));
    return head;
  });
  fillBody();
  return make("table", {}, make("thead", {}, make("tr", {}, ...heads)), body);
}
