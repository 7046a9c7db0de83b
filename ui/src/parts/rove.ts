/** Arrow keys move among the buttons of a list. */
export function rove(list: HTMLElement): { destroy(): void } {
  const pressed = (event: KeyboardEvent): void => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const all = [...list.querySelectorAll<HTMLElement>("[data-row]")];
    const at = all.indexOf(document.activeElement as HTMLElement);
    const to = event.key === "Home" ? 0 : event.key === "End" ? all.length - 1 : step === undefined || at < 0 ? -1 : at + step;
    if (!all[to]) return;
    event.preventDefault();
    all[to].focus();
  };
  list.addEventListener("keydown", pressed);
  return { destroy: () => list.removeEventListener("keydown", pressed) };
}
