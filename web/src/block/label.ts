/** Words in a canvas, where nothing breaks or clips them. */

/** `text`, or as much of it as `widthPx` of `context` has room for, with dots at its end. */
export function fitted(context: Pick<CanvasRenderingContext2D, "measureText">, text: string, widthPx: number): string {
  const letters = [...text];
  const cut = (count: number): string => (count === letters.length ? text : `${letters.slice(0, count).join("")}…`);
  let count = letters.length;
  while (count > 0 && context.measureText(cut(count)).width > widthPx) {
    count -= 1;
  }
  return cut(count);
}
